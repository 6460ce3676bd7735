/** From an edit to mistakes and a program: the newest text wins, older answers are dropped. */

import { signal } from "@preact/signals";
import type { Compiled, CompileRequest, MemoryPart } from "../protocol";
import { compiled, library, machine, project, running } from "../store";
import { compiler } from "./parts";
import { sayError } from "./say";

/** Bytes in the NPs' memory before a run. */
export const memory = signal<MemoryPart[]>([]);

/**
 * Wait for more keys before asking the compiler, in milliseconds: as long as it took the last time,
 * since what is typed meanwhile would wait for it.
 */
const PAUSE = { least: 30, most: 120 };

let pause = PAUSE.most;
/** What modules were made from that have the run form only. */
const unfinished = new WeakMap<Uint8Array, CompileRequest>();

let timer: ReturnType<typeof setTimeout> | undefined;
let asked = 0;
let pending: Promise<Compiled | null> | null = null;

export function request(module: CompileRequest["module"]): CompileRequest {
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
  }, pause);
}

/** Compile the present text; null if a newer one overtook it, or if the compiler failed. */
export async function compileNow(): Promise<Compiled | null> {
  clearTimeout(timer);
  asked += 1;
  const mine = asked;
  if (running.value) performance.mark("npchip:edit");
  const wanted = request("run");
  const start = performance.now();
  pending = compiler()
    .compile(wanted)
    .then(
      (result) => {
        if (result.module) unfinished.set(result.module, wanted);
        pause = Math.min(PAUSE.most, Math.max(PAUSE.least, performance.now() - start));
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

/** What makes the whole module of one that cannot step yet; null if it is whole. */
export function wholeOf(module: Uint8Array): (() => Promise<Uint8Array<ArrayBuffer>>) | null {
  const made = unfinished.get(module);
  return made ? () => compiler().whole(made) : null;
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
  // The compiler has to know it too: conditions and writers are those of what it compiled last.
  void compiler()
    .compile(request(false))
    .catch(() => undefined);
}
