/** Answers questions about the array with the page's own code. */

import * as format from "../../../src/npchip/studio/page/array/format";
import { moved } from "../../../src/npchip/studio/page/array/keys";
import { arrowsOf } from "../../../src/npchip/studio/page/array/moves";
import * as names from "../../../src/npchip/studio/page/array/names";
import { paint } from "../../../src/npchip/studio/page/array/paint";
import * as planes from "../../../src/npchip/studio/page/array/planes";
import { shortcuts, wayOf } from "../../../src/npchip/studio/page/array/shortcuts";
import { executed, passing, reference } from "../../../src/npchip/studio/page/array/state";
import type { Cell, ChipView, Move, ProgramInfo, Quantity } from "../../../src/npchip/studio/page/protocol";
import * as store from "../../../src/npchip/studio/page/store";
import { answering } from "../../support/answering";

/** A view as Python writes it: lists in place of arrays. */
type Written = { [Key in keyof ChipView]: ChipView[Key] extends Uint8Array ? number[] : ChipView[Key] };

function read(view: Written): ChipView {
  const bytes = Object.entries(view).map(([key, value]) => [
    key,
    Array.isArray(value) && key !== "stack" && key !== "masks" ? Uint8Array.from(value as number[]) : value,
  ]);
  return Object.fromEntries(bytes) as ChipView;
}

interface PlanesQuestion {
  view: Written;
  rows: number;
  cols: number;
  cells: Cell[];
}

interface StoryEvent {
  view?: Written;
  running?: boolean;
  pace?: typeof store.pace.value;
  program?: ProgramInfo;
}

const answers = {
  bytes: () =>
    Array.from({ length: 256 }, (_, byte) => ({
      decimal: format.format(byte, "decimal"),
      hex: format.format(byte, "hex"),
      signed: format.format(byte, "signed"),
      binary: format.binary(byte),
      shade: format.shade(byte, "signed"),
      ink: format.inkOn(byte),
    })),
  numbers: ({ texts }: { texts: string[] }) => texts.map(format.parseNumber),
  planes({ view: written, rows, cols, cells }: PlanesQuestion) {
    const view = read(written);
    const every = [...Array(rows * cols).keys()];
    return {
      banks: [0, 64, 128, 192].map((first) => [...planes.bankPicture(view.memory, first, rows, cols)]),
      bytes: every.map((at) => [...planes.bankOf(view, 64, at)]),
      pixels: every.map((at) => [
        ...planes.pixelsOf(view.exposed ?? new Uint8Array(), Math.floor(at / cols), at % cols, cols),
      ]),
      cells: cells.map((cell) => [...planes.planeOf(view, cell)]),
    };
  },
  changes({ now, before, rows, cols }: { now: number[]; before: number[] | null; rows: number; cols: number }) {
    const [a, b] = [Uint8Array.from(now), before && Uint8Array.from(before)];
    return { each: planes.changes(a, b), nps: planes.pictureChanges(a, b, rows, cols) };
  },
  names({ program, stack, quantities }: { program: ProgramInfo; stack: number[]; quantities: Quantity[] }) {
    return {
      calls: names.openCalls(program, stack),
      addresses: program.words.map((_, address) => names.addressText(program, address)),
      registers: [...Array(16).keys()].map((number) => names.registerText(program, number)),
      quantities: quantities.map(names.quantityText),
    };
  },
  arrows({ move, from, active, rows, cols }: { move: Move; from: Written; active: number[]; rows: number; cols: number }) {
    return arrowsOf(move, Uint8Array.from(active), read(from), rows, cols);
  },
  paint(question: { rows: number; cols: number; shades: number[]; inactive: number[]; changed: number[] }) {
    const { inactive, changed } = question;
    return [...paint({ ...question, picture: null, marks: { inactive, changed } })];
  },
  story({ events }: { events: StoryEvent[] }) {
    return events.map((event) => {
      if (event.program) store.program.value = event.program;
      if (event.pace) store.pace.value = event.pace;
      if (event.running !== undefined) store.running.value = event.running;
      if (event.view) store.view.value = read(event.view);
      const seen = passing.value;
      return {
        reference: reference.value?.instructions ?? null,
        executed: executed.value,
        passing: seen && { moves: seen.moves, from: seen.from?.instructions ?? null },
      };
    });
  },
  ways({ keys }: { keys: { key: string; ctrlKey?: boolean; shiftKey?: boolean; altKey?: boolean }[] }) {
    const none = { ctrlKey: false, shiftKey: false, altKey: false, metaKey: false };
    const asked = (letters: boolean) =>
      keys.map((key) => wayOf({ ...none, ...key } as KeyboardEvent, letters)?.name ?? null);
    return { everywhere: asked(false), withLetters: asked(true), shortcuts };
  },
  keys: ({ presses }: { presses: Parameters<typeof moved>[] }) => presses.map((press) => moved(...press)),
};

await answering((question) => {
  const answer = answers[question.ask as keyof typeof answers] as (asked: unknown) => unknown;
  return answer(question);
});
