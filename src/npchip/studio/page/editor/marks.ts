/** Marks that move with their lines: cycles, breakpoints, and where the program is. */

import { invertedEffects } from "@codemirror/commands";
import {
  type ChangeDesc,
  type EditorState,
  type Extension,
  StateEffect,
  type StateEffectType,
  StateField,
  type Text,
  type Transaction,
} from "@codemirror/state";
import { Decoration, EditorView } from "@codemirror/view";
import type { LineSum } from "./sums";

/** Something of a line, by the offset at which the line begins. */
type ByLine<T> = ReadonlyMap<number, T>;

/** A breakpoint: its condition, empty for none, and whether it is switched off. */
export interface LineStop {
  condition: string;
  off: boolean;
}

/** Give each line its cycles; keys are line numbers. */
export const setSums = StateEffect.define<ReadonlyMap<number, LineSum>>();
/** Set the lines with a breakpoint. */
export const setBreaks = StateEffect.define<ReadonlyMap<number, LineStop>>();
/** Set the line that the program is at, and the lines of the uses of macros around it. */
export const setHere = StateEffect.define<{ here: number | null; uses: readonly number[] }>();

/**
 * Return where the line that began at an offset begins after a change; null if it was deleted.
 * A line break at its very begin pushes it down.
 */
function carried(from: number, before: Text, changes: ChangeDesc, after: Text): number | null {
  const { to } = before.lineAt(from);
  if (to > from && changes.mapPos(from, -1) === changes.mapPos(to, 1)) return null;
  return after.lineAt(changes.mapPos(from, 1)).from;
}

function carry<T>(lines: ByLine<T>, { startState, changes, newDoc }: Transaction): ByLine<T> {
  const kept = new Map<number, T>();
  for (const [from, value] of lines) {
    const at = carried(from, startState.doc, changes, newDoc);
    if (at !== null && !kept.has(at)) kept.set(at, value);
  }
  return kept;
}

/** Put what has line numbers at the begin of its lines; a line that is not there is left out. */
function placed<T>(doc: Text, lines: Iterable<readonly [number, T]>): ByLine<T> {
  const found = new Map<number, T>();
  for (const [line, value] of lines) {
    if (line >= 1 && line <= doc.lines) found.set(doc.line(line).from, value);
  }
  return found;
}

function field<T>(type: StateEffectType<ReadonlyMap<number, T>>): StateField<ByLine<T>> {
  return StateField.define<ByLine<T>>({
    create: () => new Map(),
    update(lines, transaction) {
      let next = transaction.docChanged && lines.size ? carry(lines, transaction) : lines;
      for (const effect of transaction.effects) {
        if (effect.is(type)) next = placed(transaction.newDoc, effect.value);
      }
      return next;
    },
  });
}

/** Cycles of each line. */
export const sums = field(setSums);
/** Breakpoints of lines. */
export const breakpoints = field(setBreaks);

/** Return where a line of the program is in the text now; null if it is gone. */
export function lineNow(state: EditorState, line: number): number | null {
  for (const [from, sum] of state.field(sums)) {
    if (sum.line === line) return state.doc.lineAt(from).number;
  }
  return null;
}

/** Return the lines with a breakpoint by their number. */
export function breakLines(state: EditorState): Map<number, LineStop> {
  const lines = [...state.field(breakpoints)];
  return new Map(lines.map(([from, stop]) => [state.doc.lineAt(from).number, stop]));
}

/** Undoing the deletion of a line brings its breakpoint back. */
const restoring = invertedEffects.of((transaction) => {
  const before = transaction.startState.field(breakpoints);
  const lost = transaction.docChanged && transaction.state.field(breakpoints).size < before.size;
  return lost ? [setBreaks.of(breakLines(transaction.startState))] : [];
});

/** The program's place: `true` for the line itself, `false` for the use of a macro. */
export const position = StateField.define<ByLine<boolean>>({
  create: () => new Map(),
  update(lines, transaction) {
    let next = transaction.docChanged && lines.size ? carry(lines, transaction) : lines;
    for (const effect of transaction.effects) {
      if (!effect.is(setHere)) continue;
      const { here, uses } = effect.value;
      const all = uses.map((line) => [line, false] as const);
      next = placed(transaction.newDoc, here === null ? all : [...all, [here, true] as const]);
    }
    return next;
  },
  provide: (field) =>
    EditorView.decorations.from(field, (lines) =>
      Decoration.set(
        [...lines].map(([from, here]) => (here ? HERE : USE).range(from)),
        true,
      ),
    ),
});

const HERE = Decoration.line({ class: "editor-here" });
const USE = Decoration.line({ class: "editor-use" });

/** All that lies beside lines. */
export const marks: Extension = [sums, breakpoints, position, restoring];
