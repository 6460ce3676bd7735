/** Lines of the text that is edited, and the code that they made in the chip. */

import type { CompileRequest, ProgramInfo } from "../protocol";

/**
 * Return the line of another version of a text that a line of `text` is; null if it is not there.
 *
 * Equal lines before and behind all edits have moved as a whole. In between, a line is known by its
 * text if no other one there has the same.
 */
export function lineIn(other: string, text: string, line: number): number | null {
  const [before, after] = [other.split("\n"), text.split("\n")];
  const most = Math.min(before.length, after.length);
  let head = 0;
  while (head < most && before[head] === after[head]) head++;
  let tail = 0;
  while (tail < most - head && before.at(-1 - tail) === after.at(-1 - tail)) tail++;
  const at = line - 1;
  if (at < head) return line;
  if (at >= after.length - tail) return line + before.length - after.length;
  const here = (lines: string[]): number[] =>
    [...lines.keys()].filter((each) => each >= head && each < lines.length - tail && lines[each] === after[at]);
  const [[found, ...others], same] = [here(before), here(after)];
  return found === undefined || others.length || same.length > 1 ? null : found + 1;
}

/**
 * Return the first address of each piece of code that a line of the editor made, at every use of a
 * macro. The program was made from the text of `origin`, which may have been edited since to `now`.
 */
export function addressesOf(
  program: ProgramInfo,
  origin: CompileRequest | null,
  file: string,
  now: string | undefined,
  line: number,
): number[] {
  const old = origin?.project.files[file];
  const made = old === undefined || now === undefined ? line : lineIn(old, now, line);
  const here = program.words.map(({ origins }) => origins.some((at) => at.file === file && at.line === made));
  return [...here.keys()].filter((at) => here[at] && !here[at - 1]);
}
