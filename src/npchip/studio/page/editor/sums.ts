/** What the words of a program mean for the lines of a file: cycles, and where the program is. */

import type { Diagnostic, ProgramInfo } from "../protocol";

/** Words and cycles of a line; of a macro's line at one use, the least and the most of all uses. */
export interface LineSum {
  words: number;
  least: number;
  most: number;
  /** Uses of the macro that the line stands in; 0 outside of macros. */
  uses: number;
}

type Words = ProgramInfo["words"];

/** Return the sum of each line of a file that makes words. A line that uses a macro has all of it. */
export function lineSums(words: Words, file: string): Map<number, LineSum> {
  const lines = new Map<number, Map<string, { words: number; cycles: number }>>();
  for (const word of words) {
    const met = new Set<number>();
    for (const [depth, origin] of word.origins.entries()) {
      if (origin.file !== file || met.has(origin.line)) continue;
      met.add(origin.line);
      const outer = word.origins.slice(depth + 1);
      const use = outer.map((place) => `${place.file}:${place.line}`).join(" ");
      const uses = lines.get(origin.line) ?? new Map<string, { words: number; cycles: number }>();
      lines.set(origin.line, uses);
      const sum = uses.get(use) ?? { words: 0, cycles: 0 };
      uses.set(use, { words: sum.words + 1, cycles: sum.cycles + word.cycles });
    }
  }
  const sums = new Map<number, LineSum>();
  for (const [line, uses] of lines) {
    const all = [...uses.values()];
    const cycles = all.map((use) => use.cycles);
    sums.set(line, {
      words: Math.max(...all.map((use) => use.words)),
      least: Math.min(...cycles),
      most: Math.max(...cycles),
      uses: uses.has("") ? 0 : all.length,
    });
  }
  return sums;
}

/** Return what the gutter shows for a sum. */
export function sumText(sum: LineSum): string {
  return sum.least === sum.most ? `${sum.most}` : `${sum.least}–${sum.most}`;
}

/** Return a sum in words, for the status strip and screen readers. */
export function sumWords(sum: LineSum): string {
  const each = sum.uses > 1 ? ` at each of ${sum.uses} uses` : "";
  return `${sumText(sum)} ${sum.most === 1 ? "cycle" : "cycles"}, ${plural(sum.words, "word")}${each}`;
}

/** Return the lines of a file that an address stands for: its own, and the uses of macros. */
export function linesAt(words: Words, address: number, file: string): { here: number | null; uses: number[] } {
  const origins = words[address]?.origins ?? [];
  const [first] = origins;
  const here = first && first.file === file ? first.line : null;
  const uses = origins.slice(1).filter((origin) => origin.file === file && origin.line !== here);
  return { here, uses: [...new Set(uses.map((origin) => origin.line))] };
}

/** Return the number of mistakes in each file; those without a place count for `main`. */
export function mistakesByFile(diagnostics: readonly Diagnostic[], main: string): Map<string, number> {
  const counts = new Map<string, number>();
  for (const { place } of diagnostics) {
    const file = place?.file ?? main;
    counts.set(file, (counts.get(file) ?? 0) + 1);
  }
  return counts;
}

/** Return a number with its noun. */
export function plural(count: number, noun: string): string {
  return `${count.toLocaleString("en")} ${noun}${count === 1 ? "" : "s"}`;
}

/** Return how much of the program memory is used, and how much is left. */
export function wordsText({ words, machine, budgets }: ProgramInfo): string {
  const limit = Math.min(machine.rom_words, budgets.words ?? Infinity);
  const left = limit - words.length;
  const rest = left < 0 ? `${-left} too many` : `${left} left`;
  const of = limit < machine.rom_words ? ` of a budget of ${limit}` : ` of ${limit}`;
  return `${words.length}${of} words, ${rest}`;
}

/** Return what is known of the cycles of a frame without a run. */
export function cyclesText({ bounds, budgets }: ProgramInfo): string {
  const number = (value: number): string => value.toLocaleString("en");
  const budget = budgets.cycles === null ? "" : `, budget ${number(budgets.cycles)}`;
  if (!bounds) return budgets.cycles === null ? "" : `Cycles a frame: budget ${number(budgets.cycles)}`;
  const { least, most } = bounds;
  if (most === null) return `Cycles a frame: at least ${number(least)}${budget}`;
  return `Cycles a frame: ${least === most ? number(most) : `${number(least)} to ${number(most)}`}${budget}`;
}
