/** Searches in the past: the last moment of a kind, the last write, the cycles of a frame. */

import type { Breakpoint, NotFound, ProgramInfo, Quantity, WriteFound } from "../protocol";
import { type Hit, Watch } from "./conditions";
import type { Block } from "./description";
import { type Breathe, type Past, SLICE } from "./past";
import { Reader } from "./reading";
import { EACH, STOP, type Stepper } from "./stepper";

/** Asked before each instruction of an interval of the past; `moved` is false at its beginning. */
type Look = (chip: Stepper, block: number, moved: boolean) => void;

/** Instructions between two looks at the clock; a power of 2. */
const CLOCK = 1024;
/** Instructions of the part of the past that is looked at first. */
const NEAR = 4096;
/** Cycles to go on without a question through frames that do not matter. */
const FAR = 1 << 17;

/**
 * Look at the past up to a moment, this included, from snapshot to snapshot, the newest first.
 * `look` makes what looks at an interval; `found` tells whether the search is over.
 */
async function search(
  past: Past,
  until: number,
  look: (chip: Stepper) => Look,
  found: () => boolean,
  breathe: Breathe,
  progress: (share: number) => void,
): Promise<"done" | "given up"> {
  let chip = past.scout();
  for (const { moment, from, end } of intervals(past, until)) {
    chip = past.put(chip, moment);
    const see = look(chip);
    let hasBegun = false;
    for (let isOver = false; !isOver; ) {
      const limit = performance.now() + SLICE;
      let count = 0;
      isOver = true;
      const isLate = () => {
        isOver = performance.now() <= limit;
        return !isOver;
      };
      chip.drive((block, moved) => {
        const { time } = chip;
        if (time < from) return isLate() ? STOP : Math.min(FAR, from - time);
        // After a pause it asks again where it has looked already.
        if (moved || !hasBegun) see(chip, block, moved);
        hasBegun = true;
        if (time >= end) return STOP;
        return (++count & (CLOCK - 1)) === 0 && isLate() ? STOP : EACH;
      });
      if (!isOver && (await breathe())) return "given up";
    }
    if (found()) return "done";
    progress(until > 0 ? 1 - from / until : 1);
  }
  return "done";
}

/** Parts of the past, the newest first: from a snapshot each, to be looked at from a time on. */
function* intervals(past: Past, until: number) {
  let end = until;
  for (const moment of past.history.until(until + 1)) {
    // Most of what is sought lies near, so the newest part is small.
    if (end === until && end - moment.time > 2 * NEAR) {
      yield { moment, from: end - NEAR, end };
      end -= NEAR;
    }
    yield { moment, from: moment.time, end };
    end = moment.time;
  }
}

/** The last moment up to `until` before a block of some kind; null if there is none. */
export async function lastAt(
  past: Past,
  until: number,
  holds: (block: Block) => boolean,
  breathe: Breathe,
  progress: (share: number) => void,
): Promise<number | null | "given up"> {
  let last: number | null = null;
  const look = (chip: Stepper): Look => {
    const { blocks } = chip.instance.about;
    return (_, block) => {
      if (holds(blocks[block] as Block)) last = chip.time;
    };
  };
  const how = await search(past, until, look, () => last !== null, breathe, progress);
  return how === "given up" ? how : last;
}

/** The last moment up to `until` at which a breakpoint would have stopped. */
export async function lastHit(
  past: Past,
  until: number,
  breakpoints: Breakpoint[],
  breathe: Breathe,
  progress: (share: number) => void,
): Promise<{ time: number; hit: Hit } | null | "given up"> {
  let last: { time: number; hit: Hit } | null = null;
  const look = (chip: Stepper): Look => {
    const watch = new Watch(chip, breakpoints);
    const { blocks } = chip.instance.about;
    let previous = 0;
    let hasBegun = false;
    return (_, block) => {
      if (hasBegun) {
        const hit = watch.after((blocks[previous] as Block).address, block);
        if (hit) last = { time: chip.time, hit };
      } else watch.begin(block);
      hasBegun = true;
      previous = block;
    };
  };
  const how = await search(past, until, look, () => last !== null, breathe, progress);
  return how === "given up" ? how : last;
}

/** The last write to a cell of an NP or to a pixel before a moment, or why none was found. */
export async function lastWrite(
  past: Past,
  now: number,
  value: Quantity,
  writers: number[],
  program: ProgramInfo,
  breathe: Breathe,
  progress: (share: number) => void,
): Promise<WriteFound | NotFound> {
  if (value.kind !== "one" && value.kind !== "pixel") {
    throw new Error("only a register, flag or byte of one NP, or a pixel, has a last write");
  }
  const candidates = new Set(writers);
  let last: WriteFound | null = null;
  const look = (chip: Stepper): Look => {
    const reader = new Reader(chip);
    const { blocks } = chip.instance.about;
    let noted: { address: number; before: number; wrote: boolean | null } | null = null;
    return (_, block) => {
      reader.at(block);
      if (noted) {
        const after = reader.number(value);
        const { address, before, wrote } = noted;
        if (wrote ?? before !== after) {
          last = { address, frame: chip.frame, instruction: chip.time, before, after };
        }
      }
      const { address } = blocks[block] as Block;
      if (!candidates.has(address)) {
        noted = null;
        return;
      }
      const text = program.words[address]?.text ?? "";
      noted = { address, before: reader.number(value), wrote: writes(reader, value, text) };
    };
  };
  const how = await search(past, now, look, () => last !== null, breathe, progress);
  if (how === "given up") return how;
  // Of live frames only the last ones are kept: what was before them cannot be run again.
  return last ?? (past.history.oldest.time > 0 ? "not kept" : "never");
}

/**
 * Return whether an instruction that can write a value is about to: the NP has to be active, and
 * a store with a register in its address has to meet this byte. Null if that is not known.
 */
function writes(reader: Reader, value: Quantity, text: string): boolean | null {
  if (value.kind !== "one") return true; // a pixel: the instruction exposes
  const np = reader.np(value.row, value.column);
  if (!reader.one({ kind: "active", index: "" }, np)) return false;
  if (value.cell.kind !== "memory") return true;
  const indexed = /^\w+ +\[r(\d+)(?: *\+ *(\d+))?\]/i.exec(text);
  if (!indexed) return /^ST +\[\d+\]|^SAMPLE\b/i.test(text) ? true : null;
  const [, register = "0", bank = "0"] = indexed;
  const base = reader.one({ kind: "register", index: Number(register) }, np);
  return (base + Number(bank)) % reader.memoryBytes === value.cell.index;
}

/** Cycles by address of a frame, as far as it was executed up to a moment. */
export async function cyclesOf(
  past: Past,
  frame: number,
  until: number,
  words: number,
  breathe: Breathe,
): Promise<Float64Array<ArrayBuffer>> {
  const cycles = new Float64Array(words);
  let chip = past.scout();
  const before = past.history.until(until + 1).find((moment) => moment.frame < frame);
  const start = before ?? past.history.oldest;
  if (start.frame > frame || (start.frame === frame && start.time > 0)) {
    throw new Error(`frame ${frame} was too long ago: live frames are kept for a while only`);
  }
  chip = past.put(chip, start);
  const { blocks } = chip.instance.about;
  const add = (block: number, count: number) => {
    const { address } = blocks[block] as Block;
    cycles[address] = (cycles[address] ?? 0) + count;
  };
  let previous = chip.block;
  let last = { frame: chip.frame, cycles: chip.instance.long("cycles") };
  for (let isOver = false; !isOver; ) {
    const limit = performance.now() + SLICE;
    let count = 0;
    isOver = true;
    const guide = (block: number, moved: boolean): number => {
      const now = { frame: chip.frame, cycles: chip.instance.long("cycles") };
      if (moved && now.frame === frame) {
        add(previous, now.cycles - (now.frame === last.frame ? last.cycles : 0));
      }
      previous = block;
      last = now;
      if (chip.time >= until) return STOP;
      if ((++count & (CLOCK - 1)) === 0 && performance.now() > limit) {
        isOver = false;
        return STOP;
      }
      return now.frame < frame ? FAR : EACH;
    };
    const outcome = chip.drive(guide, (next, block) => {
      previous = block; // the frame begins with this instruction
      return next <= frame;
    });
    if (outcome === "ended" && chip.halted && last.frame === frame && chip.time <= until) {
      add(previous, chip.last.cycles - last.cycles);
    }
    if (!isOver && (await breathe())) throw new Error("the count of the cycles was stopped");
  }
  return cycles;
}
