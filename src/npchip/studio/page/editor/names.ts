/** Names that the files define, found in their text: they are known while a line is half written. */

import type { Definition, Project } from "../protocol";
import { codeEnd, split } from "./lines";

/** A name with its place, the operands of a macro, and what the assembler says of it. */
export interface Name extends Definition {
  operands: string[];
}

const DEFINES: readonly [RegExp, Definition["kind"]][] = [
  [/^\s*\.equ\s+([A-Za-z_]\w*)\s*,\s*(.*)$/di, "constant"],
  [/^\s*\.reg\s+([A-Za-z_]\w*)\s*,\s*(.*)$/di, "register"],
  [/^\s*\.macro\s+([A-Za-z_]\w*)\s*(.*)$/di, "macro"],
  [/^\s*\.output\s+([A-Za-z_]\w*)\s*,\s*(.*)$/di, "output"],
];
const LABEL = /(?<!\S)(\.?[A-Za-z_]\w*)\s*:/g;

/** Return the definitions of a file in order, local labels included. */
export function namesIn(file: string, text: string): Name[] {
  const found: Name[] = [];
  for (const [index, full] of text.split(/\r\n|\r|\n/).entries()) {
    const line = full.slice(0, codeEnd(full)).trimEnd();
    const add = (name: string, kind: Definition["kind"], at: number, rest: string): void => {
      const operands = kind === "macro" ? split(rest).map((part) => part.trim()) : [];
      const place = { file, line: index + 1, column: at + 1, length: name.length };
      found.push({ name, kind, place, text: rest.trim(), operands: operands.filter(Boolean) });
    };
    for (const [pattern, kind] of DEFINES) {
      const match = pattern.exec(line);
      const at = match?.indices?.[1]?.[0] ?? 0;
      if (match) add(match[1] as string, kind, at, match[2] as string);
    }
    LABEL.lastIndex = 0;
    let end = 0;
    for (let match = LABEL.exec(line); match; match = LABEL.exec(line)) {
      if (line.slice(end, match.index).trim()) break; // behind an instruction: no label
      add(match[1] as string, "label", match.index, "");
      end = match.index + match[0].length;
    }
  }
  return found;
}

/**
 * Return the names of all files. The text says where they are now, the assembler what they are
 * worth; names that only the assembler knows, such as those of a bundled file, come last.
 */
export function allNames(project: Project, definitions: readonly Definition[]): Name[] {
  const { main } = project;
  const files = Object.entries(project.files).sort(([a], [b]) => Number(b === main) - Number(a === main));
  const found = files.flatMap(([file, text]) => namesIn(file, text));
  const known = new Map(definitions.map((item) => [`${item.kind} ${item.name}`, item]));
  const seen = new Set<string>();
  for (const name of found) {
    const key = `${name.kind} ${name.name}`;
    seen.add(key);
    const text = known.get(key)?.text;
    if (text && !name.name.startsWith(".")) name.text = text;
  }
  const rest = definitions.filter((item) => !seen.has(`${item.kind} ${item.name}`));
  return [...found, ...rest.map((item) => ({ ...item, operands: [] }))];
}

/**
 * Return what a word at a line means: a local label is that of the nearest place above or below,
 * as far as the next label without a dot.
 */
export function lookUp(names: readonly Name[], word: string, file: string, line: number): Name | null {
  const same = names.filter((name) => name.name === word);
  if (!word.startsWith(".")) return same[0] ?? null;
  const near = same.filter((name) => name.place.file === file);
  const bounds = names
    .filter((name) => name.kind === "label" && !name.name.startsWith(".") && name.place.file === file)
    .map((name) => name.place.line);
  const region = (at: number): number => bounds.filter((bound) => bound <= at).length;
  return near.find((name) => region(name.place.line) === region(line)) ?? near[0] ?? null;
}

/** Return a test for lines that begin a repetition in the files of a project. */
export function repetitions(project: Project): (file: string, line: number) => boolean {
  const lines = new Map(Object.entries(project.files).map(([file, text]) => [file, text.split(/\r\n|\r|\n/)]));
  return (file, line) => /^(?:\s*\.?\w+\s*:)*\s*\.rept\b/i.test(lines.get(file)?.[line - 1] ?? "");
}
