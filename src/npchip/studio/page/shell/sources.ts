/** Sources from the reader's disk. */

import { useSources } from "./project";
import { sayError } from "./say";
import { isName } from "./share";

const SOURCE = /\.(s|asm|inc|txt)$/i;
/** The assembler's limit for a source with its includes. */
const MOST = 1 << 18;

export function isSource(file: File): boolean {
  return SOURCE.test(file.name);
}

/** Open sources: one becomes the program, the others its includes. */
export async function openSources(files: File[]): Promise<void> {
  try {
    const texts = await read(files);
    if (files.length) await useSources(texts);
  } catch (fault) {
    sayError(fault);
  }
}

async function read(files: File[]): Promise<Record<string, string>> {
  const texts: Record<string, string> = {};
  let total = 0;
  for (const file of files) {
    total += file.size;
    if (total > MOST) throw new Error(`${file.name}: sources of more than ${MOST >> 10} KiB cannot be assembled`);
    if (!isName(file.name)) {
      throw new Error(`'${file.name}' cannot name a source: use letters, digits, '_', '-' and '.'`);
    }
    try {
      texts[file.name] = new TextDecoder("utf-8", { fatal: true }).decode(await file.arrayBuffer());
    } catch {
      throw new Error(`${file.name} is not a text in UTF-8: save it as UTF-8 and open it again`);
    }
  }
  return texts;
}
