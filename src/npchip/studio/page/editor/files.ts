/** The files that the editor shows: those of the project, and bundled ones that it includes. */

import type { Project } from "../protocol";
import { resolve } from "./lines";

/** A change of the files that can be taken back. */
export interface Undo {
  text: string;
  project: Project;
  open: string;
}

/** Return the text of a file, and whether it is the project's own; bundled files are read only. */
export function textOf(
  file: string,
  project: Project,
  library: Readonly<Record<string, string>>,
): { text: string; own: boolean } {
  const own = project.files[file];
  return own === undefined ? { text: library[file] ?? "", own: false } : { text: own, own: true };
}

/** Files that tests compare with are no text to edit. */
const GOLDEN = /\.golden\.json$/;

/** Return the names of the tabs: the program first, its includes, and the file that is open. */
export function tabNames(project: Project, open: string): string[] {
  const names = Object.keys(project.files).filter((name) => name !== project.main && !GOLDEN.test(name));
  return [...new Set([project.main, ...names, open])];
}

/** Return what is wrong with a name for a file, or an empty text. */
export function nameFault(name: string, taken: readonly string[]): string {
  if (name === "") return "Give it a name, such as filter.s";
  if (!/^(?:[\w-][\w.-]*\/)*[\w-][\w.-]*$/.test(name)) {
    return "A name has letters, digits, '_', '-' and '.', and '/' between folders";
  }
  if (name.length > 200) return "A name has at most 200 letters";
  return taken.includes(name) ? `${name} is there already: choose another name` : "";
}

/** Return a name for a new file that is not taken. */
export function freshName(taken: readonly string[]): string {
  for (let number = 1; ; number++) {
    const name = number === 1 ? "part.s" : `part${number}.s`;
    if (!taken.includes(name)) return name;
  }
}

/** Return the project with a file under another name; `.include` lines of its folder follow. */
export function renamed(project: Project, from: string, to: string): Project {
  const entries = Object.entries(project.files).map(([name, text]) => {
    const renamedHere = name === from ? to : name;
    return [renamedHere, text.replace(INCLUDE, (whole, head: string, path: string, tail: string) =>
      resolve(name, path) === from ? `${head}${pathFrom(renamedHere, to)}${tail}` : whole)] as const;
  });
  return { main: project.main === from ? to : project.main, files: Object.fromEntries(entries) };
}

const INCLUDE = /^([ \t]*(?:\.?\w+[ \t]*:[ \t]*)*\.include[ \t]+")([^"\n]+)(")/gim;

function pathFrom(file: string, to: string): string {
  const from = file.split("/").slice(0, -1);
  const parts = to.split("/");
  while (from.length && parts.length > 1 && from[0] === parts[0]) {
    from.shift();
    parts.shift();
  }
  return [...from.map(() => ".."), ...parts].join("/");
}

/** Return the project without a file. */
export function without(project: Project, name: string): Project {
  const { [name]: _, ...files } = project.files;
  return { ...project, files };
}
