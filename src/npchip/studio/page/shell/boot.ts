/** Opens the page: a picture moves first, the assembler loads behind it. */

import { language } from "../store";
import { provide } from "../actions";
import { keepOffline } from "../offline/offline";
import { heard, say, sayError, textOf } from "../say";
import { actions, breaksFollow } from "./carry";
import { events } from "./chip";
import { keptProgram, keptTheme, useTheme } from "./keep";
import { compiler, startChip } from "./parts";
import { clipFollowsMachine } from "./machines";
import { fillLibrary, keepAlways, openExample, openShared, setAsideKept } from "./project";
import { followScene, sceneAgain } from "./scenes";
import { fromLink, type Shared } from "./share";

/** The example of a first visit. */
const FIRST = "trajectory";

export function boot(): void {
  useTheme(keptTheme());
  provide(actions);
  startChip(events);
  clipFollowsMachine();
  heard(fillLibrary());
  heard(
    openFirst().finally(() => {
      keepAlways();
      breaksFollow();
      followScene();
    }),
  );
  heard(startCompiler());
  // Errors that no part has caught are shown all the same.
  window.addEventListener("unhandledrejection", ({ reason }) => sayError(reason));
  window.addEventListener("hashchange", () => heard(openAddress()));
}

async function openFirst(): Promise<void> {
  let kept: Shared | null = null;
  let wrong: unknown = null;
  try {
    kept = keptProgram();
  } catch (fault) {
    wrong = fault;
  }
  try {
    if (location.hash && kept) await setAsideKept(kept);
    if (await openAddress()) {
      if (wrong !== null) sayError(wrong);
      return;
    }
  } catch (fault) {
    wrong = fault;
  }
  try {
    const start = wrong === null && !calm();
    if (kept) {
      await openShared(kept, start);
      await sceneAgain();
    } else await openExample(FIRST, { start });
  } catch (fault) {
    wrong ??= fault;
  }
  // Said last, as opening a clip says something too.
  if (wrong !== null) sayError(wrong);
}

/** Open the program or example that the address names; false if it names none. */
async function openAddress(): Promise<boolean> {
  const { hash } = location;
  const shared = await fromLink(hash);
  const wanted = new URLSearchParams(hash.slice(1));
  const name = wanted.get("example");
  if (shared) {
    await openShared(shared);
    say("Opened the program from the link. Press Run");
  } else if (name) await openExample(name, { clip: wanted.get("clip"), start: false });
  else return false;
  history.replaceState(null, "", hash); // until the reader changes something
  return true;
}

async function startCompiler(): Promise<void> {
  try {
    language.value = await compiler().language();
    performance.mark("npchip:compiler-ready");
  } catch (fault) {
    sayError(new Error(`The assembler could not be loaded: ${textOf(fault)}. Examples still run`));
  }
  await keepOffline();
}

/** True if the reader asks for less motion. */
function calm(): boolean {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}
