/** From a name to its definition, from an `.include` to its file, and back. */

import type { Text } from "@codemirror/state";
import { included, resolve, wordAt } from "./lines";
import { lookUp, type Name } from "./names";

/** A place to go to; the column counts from 1. */
export interface Target {
  file: string;
  line: number;
  column: number;
}

/** Return what stands at a position leads to, or null. */
export function targetAt(
  doc: Text,
  pos: number,
  file: string,
  names: readonly Name[],
  files: readonly string[],
): Target | null {
  const line = doc.lineAt(pos);
  const path = included(line.text);
  const word = wordAt(line.text, pos - line.from);
  if (path !== null) {
    const near = resolve(file, path);
    const name = files.includes(near) ? near : path;
    return files.includes(name) ? { file: name, line: 1, column: 1 } : null;
  }
  const found = word && lookUp(names, line.text.slice(word.from, word.to), file, line.number);
  return found ? { file: found.place.file, line: found.place.line, column: found.place.column } : null;
}

/** The places that jumps left, the newest last. */
export class Trail {
  private readonly places: { file: string; pos: number }[] = [];

  /** Remember a place; the oldest is forgotten after a hundred. */
  leave(file: string, pos: number): void {
    this.places.push({ file, pos });
    if (this.places.length > 100) this.places.shift();
  }

  /** Return the last place whose file still is there, and forget it. */
  back(exists: (file: string) => boolean): { file: string; pos: number } | null {
    for (let place = this.places.pop(); place; place = this.places.pop()) {
      if (exists(place.file)) return place;
    }
    return null;
  }
}
