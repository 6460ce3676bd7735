/** The bundled programs, translated when the page was built so that they run at once. */

import type { Compiled, MachineChoice, MemoryPart, Project } from "../protocol";

/** The machine that the page opens with. */
const TRANSLATED_FOR = "default";

export interface Example {
  name: string;
  /** One line. */
  summary: string;
  project: Project;
  /** The clip that shows it best; null if the page has none. */
  clip: string | null;
  /** Bytes in the NPs' memory before it runs; the translated module holds them. */
  memory: MemoryPart[];
  /** The part that the page lacks to run it, such as a second camera; null if none. */
  note: string | null;
  /** An exercise of the course: its first lines say what to do, its checks what holds. */
  lesson: boolean;
}

let all: Promise<Example[]> | null = null;

export function examples(): Promise<Example[]> {
  all ??= fetched("programs/index.json")
    .then((response) => response.json() as Promise<(Omit<Example, "memory"> & { memory: Packed[] })[]>)
    .then((found) => found.map((each) => ({ ...each, memory: each.memory.map(unpacked) })))
    .catch((fault: unknown) => {
      all = null; // the next call tries again
      throw fault;
    });
  return all;
}

/** Return an example as the compiler would; null for a lesson, and for a machine that it was not translated for. */
export async function translated(example: Example, machine: MachineChoice): Promise<Compiled | null> {
  if (example.lesson || machine.name !== TRANSLATED_FOR || machine.text !== undefined) return null;
  try {
    const [text, module] = await Promise.all([
      fetched(`programs/${example.name}.json`).then((found) => found.json() as Promise<Compiled>),
      fetched(`programs/${example.name}.wasm`).then((found) => found.arrayBuffer()),
    ]);
    return { ...text, module: new Uint8Array(module) };
  } catch {
    return null;
  }
}

type Packed = Omit<MemoryPart, "data"> & { data: string };

function unpacked(part: Packed): MemoryPart {
  return { ...part, data: Uint8Array.from(atob(part.data), (letter) => letter.charCodeAt(0)) };
}

async function fetched(path: string): Promise<Response> {
  const response = await fetch(path);
  if (!response.ok) throw new Error(`${path} is missing from this page: build it again`);
  return response;
}
