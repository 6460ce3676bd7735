/** From an edit to mistakes and a program: the newest text wins, and nothing is compiled twice. */

import { signal } from "@preact/signals";
import type { Compiled, CompileRequest, MemoryPart } from "../protocol";
import { compiled, library, machine, project, running } from "../store";
import { heard, sayError } from "../say";
import { compiler } from "./parts";

/** Bytes in the NPs' memory before a run. */
export const memory = signal<MemoryPart[]>([]);

/**
 * Wait for more keys before asking the compiler, in milliseconds: as long as it took the last time,
 * since what is typed meanwhile would wait for it.
 */
const PAUSE = { least: 30, most: 120 };
/** Bounds take the compiler up to seconds: wait until the reader does something else. */
const BOUNDS_PAUSE = 1500;

/** All that a result depends on. Each is replaced when it changes, so that `===` tells. */
type Inputs = readonly unknown[];

let pause = PAUSE.most;
/** Requests that modules were made from. */
const origins = new WeakMap<Uint8Array, CompileRequest>();
/** Modules that have the run form only. */
const unfinished = new WeakSet<Uint8Array>();

let timer: ReturnType<typeof setTimeout> | undefined;
let boundsTimer: ReturnType<typeof setTimeout> | undefined;
/** The newest request or result, which serves all who ask for the same. */
let newest: { of: Inputs; answer: Promise<Compiled | null> } | null = null;

function inputs(): Inputs {
  return [project.peek(), machine.peek(), memory.peek(), library.peek()];
}

function isPresent(of: Inputs): boolean {
  const now = inputs();
  return of.every((each, index) => each === now[index]);
}

export function request(module: CompileRequest["module"]): CompileRequest {
  return {
    project: { ...project.peek(), files: { ...library.peek(), ...project.peek().files } },
    machine: machine.peek(),
    defines: {},
    memory: memory.peek(),
    module,
  };
}

/** Compile soon, once the reader pauses; `then` gets the result. */
export function compileSoon(then: (result: Compiled) => void): void {
  clearTimeout(timer);
  timer = setTimeout(() => {
    const done = compileNow().then((result) => {
      if (result) then(result);
    });
    heard(done);
  }, pause);
}

/** Return the result of the present text, compiled now if need be; null if the compiler failed. */
export function compileNow(): Promise<Compiled | null> {
  const of = inputs();
  if (newest && isPresent(newest.of)) return newest.answer;
  clearTimeout(boundsTimer);
  const wanted = request("run");
  const start = performance.now();
  const answer = compiler()
    .compile(wanted)
    .then(
      (result) => {
        if (result.module) {
          origins.set(result.module, wanted);
          unfinished.add(result.module);
        }
        pause = Math.min(PAUSE.most, Math.max(PAUSE.least, performance.now() - start));
        if (!isPresent(of)) return compileNow();
        compiled.value = result;
        if (result.program) boundsSoon(result);
        return result;
      },
      (fault: unknown) => {
        newest = null;
        sayError(fault);
        return null;
      },
    );
  newest = { of, answer };
  return answer;
}

/** Find the bounds once the reader rests: an edit of a program that runs must not wait for them. */
function boundsSoon(result: Compiled): void {
  clearTimeout(boundsTimer);
  boundsTimer = setTimeout(() => {
    if (running.peek()) boundsSoon(result);
    else heard(boundsOf(result));
  }, BOUNDS_PAUSE);
}

/** Return a function that completes a module that cannot step yet; null if it is complete. */
export function wholeOf(module: Uint8Array): (() => Promise<Uint8Array<ArrayBuffer>>) | null {
  const made = originOf(module);
  return made && unfinished.has(module) ? () => compiler().whole(made) : null;
}

/** Return the request that a module was made from; null if there is no module. */
export function originOf(module: Uint8Array | null): CompileRequest | null {
  return (module && origins.get(module)) ?? null;
}

/** Find the bounds of a frame's cycles, which takes longer than all else. */
async function boundsOf(result: Compiled): Promise<void> {
  const origin = originOf(result.module);
  if (!result.program || !origin || compiled.peek() !== result) return;
  const bounds = await compiler().bounds(origin).catch(() => null);
  if (compiled.peek() === result) {
    compiled.value = { ...result, program: { ...result.program, bounds } };
  }
}

/** Use a result that was made before, such as a bundled program's; drop answers on the way. */
export function useCompiled(result: Compiled): void {
  clearTimeout(timer);
  clearTimeout(boundsTimer);
  newest = { of: inputs(), answer: Promise.resolve(result) };
  if (result.module) origins.set(result.module, request("run"));
  compiled.value = result;
}

/** Return a function that tells whether what a result depends on is as it is now. */
export function unlessChanged(): () => boolean {
  const of = inputs();
  return () => isPresent(of);
}
