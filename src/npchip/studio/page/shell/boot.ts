/** What happens when the page opens: a picture moves first, the assembler loads behind it. */

import { effect } from "@preact/signals";
import { compiled, language, project } from "../store";
import { provide } from "../actions";
import { keepOffline } from "../offline/offline";
import { actions, breaksFollow } from "./carry";
import { events } from "./chip";
import { compileNow } from "./compile";
import { keptProgram, keptTheme, useTheme } from "./keep";
import { compiler, missing, startChip } from "./parts";
import { fillLibrary, keepAlways, openExample, openShared } from "./project";
import { say, sayError, textOf } from "./say";
import { fromLink, type Shared } from "./share";

/** The example of a first visit. */
const FIRST = "trajectory";

export function boot(): void {
  useTheme(keptTheme());
  provide(actions);
  startChip(events);
  void fillLibrary().catch(sayError);
  void openFirst().finally(() => {
    keepAlways();
    breaksFollow();
  });
  void startCompiler();
  window.addEventListener("hashchange", () => void openAddress());
}

async function openFirst(): Promise<void> {
  try {
    const linked = await openAddress();
    if (linked) return;
    const kept = keptProgram();
    if (kept) {
      await openShared(kept);
      return;
    }
    await openExample(FIRST, { start: !calm() });
  } catch (fault) {
    sayError(fault);
  }
}

/** Open the program or example that the address names; false if it names none. */
async function openAddress(): Promise<boolean> {
  let shared: Shared | null;
  try {
    shared = await fromLink(location.hash);
  } catch (fault) {
    sayError(fault);
    const kept = keptProgram();
    if (kept) await openShared(kept);
    else await openExample(FIRST, { start: false });
    sayError(fault);
    return true;
  }
  if (shared) {
    await openShared(shared);
    say("Opened the program of the link. Press Run");
    return true;
  }
  const wanted = new URLSearchParams(location.hash.slice(1));
  const name = wanted.get("example");
  if (!name) return false;
  await openExample(name, { clip: wanted.get("clip"), start: false });
  return true;
}

async function startCompiler(): Promise<void> {
  try {
    language.value = await compiler().language();
    performance.mark("npchip:compiler-ready");
    effect(() => {
      // A program that was kept or shared has not been assembled yet.
      if (compiled.value === null && project.value.files[project.value.main]) void compileNow();
    });
  } catch (fault) {
    missing.value = textOf(fault);
    sayError(new Error(`The assembler could not be loaded: ${textOf(fault)}. Examples still run`));
  }
  await keepOffline();
}

/** True if the reader asks for less motion. */
export function calm(): boolean {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}
