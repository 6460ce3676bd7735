/** Groups the cycles of a frame by label or by source line, as `npchip profile` does. */

import type { ProgramInfo } from "../protocol";

/** A part of the program with the cycles that a frame spent in it. */
export interface Part {
  name: string;
  address: number;
  words: number;
  cycles: number;
  /** Its first line in the source. */
  place: { file: string; line: number } | null;
}

/** Name of the words above the first label. */
const START = "(start)";

/** Return the parts from each label to the next, in the order of their addresses. */
export function byLabel(program: ProgramInfo, cycles: Float64Array): Part[] {
  const names = new Map<number, string>([[0, START]]);
  // The first of several labels at an address names it.
  for (const [name, address] of Object.entries(program.labels).reverse()) names.set(address, name);
  const count = program.words.length;
  const starts = [...names.keys()].filter((address) => address < count).sort((a, b) => a - b);
  return starts.map((start, at) => {
    const end = starts[at + 1] ?? count;
    const name = names.get(start) as string;
    return {
      name,
      address: start,
      words: end - start,
      cycles: sum(cycles, start, end),
      place: definitionOf(program, name) ?? placeOf(program, start),
    };
  });
}

/** Return the source lines with their cycles; a macro's cycles count at the lines of its body. */
export function byLine(program: ProgramInfo, cycles: Float64Array): Part[] {
  const lines = new Map<string, Part>();
  program.words.forEach((word, address) => {
    const [origin] = word.origins;
    const key = origin ? `${origin.file}:${origin.line}` : `0x${hex(address)}`;
    let part = lines.get(key);
    if (!part) {
      const place = origin ? { file: origin.file, line: origin.line } : null;
      part = { name: key, address, words: 0, cycles: 0, place };
      lines.set(key, part);
    }
    part.words += 1;
    part.cycles += cycles[address] ?? 0;
  });
  return [...lines.values()];
}

/** Return the parts that took cycles, the dearest first. */
export function ranked(parts: readonly Part[]): Part[] {
  return parts
    .filter((part) => part.cycles > 0)
    .sort((a, b) => b.cycles - a.cycles || a.address - b.address);
}

/** Return a share as text; only 0 reads 0.0% and only 1 reads 100.0%. */
export function percent(part: number): string {
  let shown = (100 * part).toFixed(1);
  if (shown === "0.0" && part > 0) shown = "<0.1";
  if (shown === "100.0" && part < 1) shown = ">99.9";
  return `${shown}%`;
}

/** Return the frames a second of a number of cycles at a clock, as text with three digits. */
export function frameRate(cycles: number, clock: number): string {
  const rate = clock / cycles;
  return Number(rate.toPrecision(3)).toLocaleString("en", { maximumFractionDigits: 2 });
}

function sum(cycles: Float64Array, start: number, end: number): number {
  let total = 0;
  for (let address = start; address < end; address++) total += cycles[address] ?? 0;
  return total;
}

function placeOf(program: ProgramInfo, address: number): { file: string; line: number } | null {
  const origin = program.words[address]?.origins[0];
  return origin ? { file: origin.file, line: origin.line } : null;
}

function definitionOf(
  program: ProgramInfo,
  name: string,
): { file: string; line: number } | undefined {
  const found = program.definitions.find((each) => each.kind === "label" && each.name === name);
  return found && { file: found.place.file, line: found.place.line };
}

function hex(address: number): string {
  return address.toString(16).toUpperCase().padStart(3, "0");
}
