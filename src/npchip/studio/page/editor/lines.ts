/** Parts of a line of assembly, and the layout of lines. */

/** Columns at which the words of a line begin: instruction, operands, and comment. */
export const STOPS = [8, 16, 32] as const;

const LABELS = /^(?:\s*\.?[A-Za-z_]\w*\s*:)*/;
const WORD = /[.\w]/;

/** The cursor's place in a line. */
export interface Spot {
  /** `first`: at an instruction, directive or macro; `operand`: behind one; `none`: in a comment or string. */
  kind: "first" | "operand" | "none";
  /** The first word of the line behind its labels, in the case it has. */
  head: string;
  /** The number of the operand, from 0. */
  index: number;
  /** Text of the operand before the cursor. */
  operand: string;
  /** Offset of the word that the cursor is in or behind. */
  from: number;
}

/** Return what stands before an offset of a line. */
export function spot(line: string, offset: number): Spot {
  const before = line.slice(0, offset);
  const bare = before.replace(/"[^"]*"|'(?:\\.|[^'\\])'/g, (text) => " ".repeat(text.length));
  let from = offset;
  while (from > 0 && WORD.test(line[from - 1] as string)) from--;
  const labels = LABELS.exec(bare)?.[0].length ?? 0;
  const statement = bare.slice(labels);
  const head = /^\s*([.\w]*)/.exec(statement) as RegExpExecArray;
  const rest = statement.slice(head[0].length);
  const word = head[1] as string;
  if (/[;"]/.test(bare)) return { kind: "none", head: word, index: 0, operand: "", from };
  if (rest === "") return { kind: "first", head: word, index: 0, operand: "", from };
  const operands = split(rest);
  const operand = (operands[operands.length - 1] as string).trimStart();
  return { kind: "operand", head: word, index: operands.length - 1, operand, from };
}

/** Split at commas that stand in no bracket. */
export function split(text: string): string[] {
  const parts = [""];
  let depth = 0;
  for (const char of text) {
    if ("([".includes(char)) depth++;
    if (")]".includes(char)) depth--;
    if (char === "," && depth <= 0) parts.push("");
    else parts[parts.length - 1] += char;
  }
  return parts;
}

/** Return the word around an offset of a line, such as `place`, `.row` or `ADD`; null for none. */
export function wordAt(line: string, offset: number): { from: number; to: number } | null {
  let from = offset;
  let to = offset;
  while (from > 0 && WORD.test(line[from - 1] as string)) from--;
  while (to < line.length && WORD.test(line[to] as string)) to++;
  return from < to ? { from, to } : null;
}

/** Return the offset of the comment of a line, or its length. */
export function codeEnd(line: string): number {
  const bare = line.replace(/"[^"]*"|'(?:\\.|[^'\\])'/g, (text) => " ".repeat(text.length));
  const at = bare.indexOf(";");
  return at < 0 ? line.length : at;
}

/** Return the path that an `.include` of the line names, or null. */
export function included(line: string): string | null {
  return /^(?:\s*\.?[A-Za-z_]\w*\s*:)*\s*\.include\s+"([^"]+)"/i.exec(line)?.[1] ?? null;
}

/** Return the name of the file that `file` includes as `wanted`; folders are relative to it. */
export function resolve(file: string, wanted: string): string {
  const parts = file.split("/").slice(0, -1);
  for (const part of wanted.split("/")) {
    if (part === "..") parts.pop();
    else if (part !== "." && part !== "") parts.push(part);
  }
  return parts.join("/");
}

const OPENS = /^(?:WHERE|ELSE)$/i;
const CLOSES = /^(?:END|ELSE)$/i;
const FLUSH = /^\.(?:macro|endm)$/i;
/** Directives that stand at the margin before code. */
const BEFORE_CODE = /^\.(?:macro|if|ifn?def|elif|else)$/i;

/** Words that move their line to the left once they are complete. */
export const CLOSING = /^\s*(?:END|ELSE|\.endm)$/i;

/**
 * Return the columns that a line is indented by: as the one above it, two more in a masked region.
 *
 * @param above the nearest line above that is not blank; empty for none.
 * @param line the line itself.
 */
export function indentation(above: string, line: string): number {
  const word = head(line);
  if (FLUSH.test(word)) return 0;
  const upper = head(above);
  const blanks = /^\s*/.exec(above)?.[0].length ?? 0;
  const starts = blanks === 0 && (LABELLED.test(above) || BEFORE_CODE.test(upper));
  let columns: number = starts ? STOPS[0] : blanks;
  if (OPENS.test(upper)) columns += 2;
  if (CLOSES.test(word)) columns -= 2;
  return Math.max(0, columns);
}

const LABELLED = /^\.?[A-Za-z_]\w*\s*:/;

function head(line: string): string {
  return /^(?:\s*\.?[A-Za-z_]\w*\s*:)*\s*([.\w]*)/.exec(line)?.[1] ?? "";
}

/** Return the blanks that lead from a column to the next stop; at least one. */
export function toStop(column: number): string {
  const stop = STOPS.find((stop) => stop > column) ?? column + 8 - (column % 8);
  return " ".repeat(stop - column);
}
