/** The compiler and the chip, each in a worker of its own. */

import { signal } from "@preact/signals";
import { createCompiler, type Loading } from "../compiler/client";
import { createChip } from "../machine/client";
import type { ChipClient, ChipEvents, Compiler } from "../protocol";

/** Progress of loading the compiler; null once it is there. */
export const loading = signal<Loading | null>({ text: "Loading the assembler", share: null });

let compilerPart: Compiler | null = null;
let chipPart: ChipClient | null = null;

export function compiler(): Compiler {
  compilerPart ??= createCompiler(
    () => new Worker(new URL("compiler.js", document.baseURI), { type: "module", name: "compiler" }),
    (now) => {
      loading.value = now;
    },
  );
  return compilerPart;
}

/** Make the chip; `events` hears it from now on. */
export function startChip(events: ChipEvents): ChipClient {
  chipPart = createChip(
    () => new Worker(new URL("machine.js", document.baseURI), { type: "module", name: "chip" }),
    events,
  );
  return chipPart;
}

export function chip(): ChipClient {
  if (!chipPart) throw new Error("the chip was not started");
  return chipPart;
}
