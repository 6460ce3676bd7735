/** The words of a program summed up for the lines of a file: cycles, and where the program is. */

import type { Diagnostic, ProgramInfo } from "../protocol";

/** Words and cycles of one copy of a line: macros and repetitions make several, which can differ. */
export interface LineSum {
  /** The line in the program; it moves in the text while that is edited. */
  line: number;
  words: number;
  least: number;
  most: number;
  copies: number;
}

type Words = ProgramInfo["words"];
type Origin = Words[number]["origins"][number];

interface Copy {
  line: number;
  words: number;
  cycles: number;
  /** Address of its last word, and where that stands in what the line makes, the outermost first. */
  last: number;
  inner: readonly Origin[];
}

/**
 * Return the sum of each line of a file that makes words. A line that uses a macro has all that the
 * use makes, and a `.rept` line all of its copies.
 *
 * @param repeats tells whether a line is a `.rept`.
 */
export function lineSums(
  words: Words,
  file: string,
  repeats: (file: string, line: number) => boolean,
): Map<number, LineSum> {
  const copies: Copy[] = [];
  const open = new Map<string, Copy>();
  for (const [address, { origins, cycles }] of words.entries()) {
    for (const [depth, origin] of origins.entries()) {
      // An instruction that a macro got as an argument stands in the line of the use: that counts once.
      const outer = origins.slice(depth + 1);
      if (origin.file !== file || outer.some((place) => isSame(place, origin))) continue;
      const inner = origins.slice(0, depth).reverse();
      const key = origins.slice(depth).map((place) => `${place.file}:${place.line}`).join(" ");
      const before = open.get(key);
      const whole = repeats(origin.file, origin.line);
      // Nothing tells where in a macro such an argument is used.
      const argument = inner.some((place) => isSame(place, origin));
      const joins = whole || argument || (before && follows(before.inner, inner, repeats));
      const goesOn = before?.last === address - 1 && joins;
      const copy: Copy = goesOn ? before : { line: origin.line, words: 0, cycles: 0, last: 0, inner: [] };
      if (!goesOn) copies.push(copy);
      copy.words += 1;
      copy.cycles += cycles;
      copy.last = address;
      if (!argument) copy.inner = inner;
      open.set(key, copy);
    }
  }
  const sums = new Map<number, LineSum>();
  for (const { line, words: count, cycles } of copies) {
    const sum = sums.get(line) ?? { line, words: 0, least: cycles, most: cycles, copies: 0 };
    sums.set(line, {
      line,
      words: Math.max(sum.words, count),
      least: Math.min(sum.least, cycles),
      most: Math.max(sum.most, cycles),
      copies: sum.copies + 1,
    });
  }
  return sums;
}

function isSame(one: Origin, other: Origin): boolean {
  return one.line === other.line && one.file === other.file;
}

/**
 * Return whether a word can belong to the same copy as the one before it: it stands further down
 * in what the line makes, or in another copy of a repetition there. An instruction makes one word.
 */
function follows(
  before: readonly Origin[],
  after: readonly Origin[],
  repeats: (file: string, line: number) => boolean,
): boolean {
  for (const [index, origin] of after.entries()) {
    const other = before[index];
    if (other?.file !== origin.file) return true;
    if (other.line !== origin.line) return other.line < origin.line;
    if (repeats(origin.file, origin.line)) return true;
  }
  return false;
}

/** Return what the gutter shows for a sum. */
export function sumText(sum: LineSum): string {
  return sum.least === sum.most ? `${sum.most}` : `${sum.least}–${sum.most}`;
}

/** Return a sum in words, for the status strip and screen readers. */
export function sumWords(sum: LineSum): string {
  const each = sum.copies > 1 ? ` in each of ${sum.copies} copies` : "";
  return `${sumText(sum)} ${sum.most === 1 ? "cycle" : "cycles"}, ${plural(sum.words, "word")}${each}`;
}

/** Return the lines of a file that an address stands for: its own, and the uses of macros. */
export function linesAt(
  words: Words,
  address: number,
  file: string,
): { here: number | null; uses: number[] } {
  const origins = words[address]?.origins ?? [];
  const [first] = origins;
  const here = first && first.file === file ? first.line : null;
  const uses = origins.slice(1).filter((origin) => origin.file === file && origin.line !== here);
  return { here, uses: [...new Set(uses.map((origin) => origin.line))] };
}

/** Return the number of mistakes in a file; those without a place count for `main`. */
export function mistakesIn(
  file: string,
  diagnostics: readonly Diagnostic[],
  main: string,
): { errors: number; warnings: number } {
  const here = diagnostics.filter(({ place }) => (place?.file ?? main) === file);
  const errors = here.filter(({ severity }) => severity === "error").length;
  return { errors, warnings: here.length - errors };
}

/** Return a number with its noun. */
export function plural(count: number, noun: string): string {
  return `${count.toLocaleString("en")} ${noun}${count === 1 ? "" : "s"}`;
}

/** Return how much of the program memory is used, and how much is left. */
export function wordsText({ words, machine, budgets }: ProgramInfo): string {
  const left = machine.rom_words - words.length;
  const rest = left < 0 ? `${-left} too many` : `${left} left`;
  const budget = budgets.words === null ? "" : `, budget ${budgets.words}`;
  return `${words.length} of ${machine.rom_words} words, ${rest}${budget}`;
}

/** Return what is known of the cycles of a frame without a run; empty if nothing is. */
export function cyclesText({ bounds, budgets }: ProgramInfo): string {
  const number = (value: number): string => value.toLocaleString("en");
  const budget = budgets.cycles === null ? "" : `budget ${number(budgets.cycles)}`;
  if (!bounds) return budget && `Cycles a frame: ${budget}`;
  const { least, most } = bounds;
  const upTo = least === most ? number(least) : `${number(least)}–${number(most ?? 0)}`;
  return [`${most === null ? `at least ${number(least)}` : upTo} cycles a frame`, budget].filter(Boolean).join(", ");
}
