/** From an edit to mistakes and a program: the newest text wins, older answers are dropped. */

import { signal } from "@preact/signals";
import type { Compiled, CompileRequest, MemoryPart } from "../protocol";
import { compiled, library, machine, project, running } from "../store";
import { compiler } from "./parts";
import { sayError } from "./say";

/** Bytes in the NPs' memory before a run. */
export const memory = signal<MemoryPart[]>([]);

/** Wait this long after a key before asking the compiler, in milliseconds. */
const PAUSE = 120;

let timer: ReturnType<typeof setTimeout> | undefined;
let asked = 0;
let pending: Promise<Compiled | null> | null = null;

export function request(module: boolean): CompileRequest {
  return {
    project: { ...project.value, files: { ...library.value, ...project.value.files } },
    machine: machine.value,
    defines: {},
    memory: memory.value,
    module,
  };
}

/** Compile soon, once the reader pauses; `then` gets the result if it is still the newest. */
export function compileSoon(then: (result: Compiled) => void): void {
  clearTimeout(timer);
  asked += 1;
  timer = setTimeout(() => {
    void compileNow().then((result) => {
      if (result) then(result);
    });
  }, PAUSE);
}

/** Compile the present text; null if a newer one overtook it, or if the compiler failed. */
export async function compileNow(): Promise<Compiled | null> {
  clearTimeout(timer);
  asked += 1;
  const mine = asked;
  if (running.value) performance.mark("npchip:edit");
  pending = compiler()
    .compile(request(true))
    .then(
      (result) => {
        if (mine !== asked) return null;
        compiled.value = result;
        void boundsOf(result);
        return result;
      },
      (fault: unknown) => {
        if (mine === asked) sayError(fault);
        return null;
      },
    );
  return pending;
}

/** Find the bounds of a frame's cycles, which takes longer than all else. */
async function boundsOf(result: Compiled): Promise<void> {
  if (!result.program) return;
  const bounds = await compiler().bounds().catch(() => null);
  if (compiled.value === result) {
    compiled.value = { ...result, program: { ...result.program, bounds } };
  }
}

/** Use a result that was made before, such as a bundled program's; drop answers on the way. */
export function useCompiled(result: Compiled): void {
  clearTimeout(timer);
  asked += 1;
  compiled.value = result;
}
