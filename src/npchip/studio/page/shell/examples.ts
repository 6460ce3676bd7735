/** The bundled programs, translated when the page was built so that they run at once. */

import type { Compiled, Diagnostic, MemoryPart, ProgramInfo, Project } from "../protocol";

export interface Example {
  name: string;
  /** One line. */
  title: string;
  project: Project;
  /** The clip that shows it best; null if the program takes no frames. */
  clip: string | null;
  /** What lies in the NPs' memory before it runs. */
  memory: MemoryPart[];
  /** Machines that it was translated for. */
  machines: string[];
}

let all: Promise<Example[]> | null = null;

export function examples(): Promise<Example[]> {
  all ??= json<Example[]>("programs/index.json");
  return all;
}

/** Return an example as the compiler would; null if it was not translated for that machine. */
export async function translated(example: Example, machine: string): Promise<Compiled | null> {
  if (!example.machines.includes(machine)) return null;
  const stem = `programs/${example.name}.${machine}`;
  const [text, module] = await Promise.all([
    json<{ program: ProgramInfo; diagnostics: Diagnostic[] }>(`${stem}.json`),
    bytes(`${stem}.wasm`),
  ]);
  return { ...text, module, milliseconds: { assemble: 0, translate: 0 } };
}

async function json<T>(path: string): Promise<T> {
  return (await found(path)).json() as Promise<T>;
}

async function bytes(path: string): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array(await (await found(path)).arrayBuffer());
}

async function found(path: string): Promise<Response> {
  const response = await fetch(path);
  if (!response.ok) throw new Error(`${path} is missing from this page: build it again`);
  return response;
}
