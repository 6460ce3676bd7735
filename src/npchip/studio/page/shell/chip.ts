/** Runs, steps and what the chip tells of them. */

import { batch, signal } from "@preact/signals";
import type { Breakpoint, ChipEvents, ChipView, Compiled, FrameBatch, Stop, Travel } from "../protocol";
import { trim } from "../results/trim";
import {
  batches,
  breakKey,
  breaks,
  compiled,
  conditions,
  disabled,
  frameCount,
  pace,
  program,
  progress,
  running,
  shownFrame,
  stop,
  verdicts,
  view,
} from "../store";
import { compileNow } from "./compile";
import { chip, compiler } from "./parts";
import { say, sayError } from "./say";
import { complete, stepNow } from "./stepping";

/** The default of `npchip run`. */
const MAX_CYCLES = 50_000_000;
/** A chip that does not stop within this time is ended, in milliseconds. */
const PATIENCE = 1500;

/** True if the text is newer than the program in the chip. */
export const stale = signal(false);

/** The module in the chip; null if there is none, or if it was ended. */
let inChip: Compiled["module"] = null;
let firstPicture = false;

export const events: ChipEvents = {
  frames(part: FrameBatch): void {
    batches.value = trim([...batches.value, part]);
    if (!firstPicture) {
      firstPicture = true;
      performance.mark("npchip:first-picture");
    }
    if (performance.getEntriesByName("npchip:edit").length) {
      performance.measure("npchip:edit-to-result", "npchip:edit");
      performance.clearMarks("npchip:edit");
    }
  },
  view(seen: ChipView): void {
    view.value = seen;
  },
  stopped(why: Stop): void {
    stopped(why);
  },
  progress(share: number): void {
    progress.value = { text: "Looking back", share };
  },
  failed(text: string): void {
    running.value = false;
    sayError(new Error(text));
  },
};

function stopped(why: Stop): void {
  batch(() => {
    running.value = false;
    stop.value = why;
    progress.value = null;
  });
  const seen = view.value;
  if (why.reason === "ended" && seen?.status === "failed" && seen.error) {
    sayError(new Error(`The program failed at address ${seen.error.address}: ${seen.error.message} [${seen.error.code}]`));
  } else if (why.reason === "ended" && seen?.status === "cycle-limit") {
    sayError(new Error(`A frame took more than ${MAX_CYCLES.toLocaleString("en")} cycles: does the program loop for ever?`));
  } else if (why.reason === "ended") {
    const frames = frameCount.value;
    say(`${seen?.status === "halted" ? "Halted" : "End of the clip"} after ${frames} frame${frames === 1 ? "" : "s"}`);
  } else say(why.text);
}

/** Put the newest program into the chip, if there is one that is newer. */
export async function bringUp(): Promise<boolean> {
  let newest = compiled.value;
  if (stale.value || !newest?.module) newest = await compileNow();
  if (!newest?.program || !newest.module) {
    const count = compiled.value?.diagnostics.filter((each) => each.severity === "error").length ?? 0;
    if (count) sayError(new Error(`The program has ${count} mistake${count === 1 ? "" : "s"}: mend it before it can run`));
    return false;
  }
  if (newest.module !== inChip) await put(newest);
  return true;
}

/** Put a program into the chip. What the old one has shown goes. */
export async function put(made: Compiled): Promise<void> {
  if (!made.program || !made.module) return;
  running.value = false;
  inChip = made.module;
  await chip().load(made.module.slice(), made.program, MAX_CYCLES);
  void complete(made.module, () => inChip === made.module);
  forget();
  batch(() => {
    program.value = made.program;
    stale.value = false;
  });
  await setBreaks();
}

/** Forget the outputs of a run. */
export function forget(): void {
  batch(() => {
    batches.value = [];
    shownFrame.value = null;
    stop.value = null;
    verdicts.value = null;
  });
}

export async function run(): Promise<void> {
  if (!(await bringUp())) return;
  if (view.value?.ended) await reset();
  running.value = true;
  say("Running");
  if (pace.value !== "max" || breaks.value.length || conditions.value.length) stepNow();
  chip().run(pace.value);
}

/** Stop, even a chip that hears nothing; then the program is put in again. */
export function pause(): void {
  chip().pause();
  setTimeout(() => {
    if (!running.value) return;
    chip().terminate();
    running.value = false;
    inChip = null;
    sayError(new Error("The chip did not answer and was stopped. Your program is kept: press Run to start again"));
  }, PATIENCE);
}

export async function reset(): Promise<void> {
  running.value = false;
  forget();
  if (!inChip || stale.value) {
    inChip = null;
    await bringUp();
  } else await chip().reset();
}

export async function go(travel: Travel, back: boolean): Promise<void> {
  if (running.value) return;
  if (!(await bringUp())) return;
  if (view.value?.ended && !back) {
    say("The run has ended: reset it, or step back");
    return;
  }
  running.value = true;
  stepNow();
  try {
    stopped(await chip().go(travel, back));
  } catch (fault) {
    running.value = false;
    sayError(fault);
  }
}

/** Give the chip the breakpoints of lines and the conditions; each that cannot be read is told. */
export async function setBreaks(): Promise<void> {
  const made = program.value;
  if (!made) return;
  const all: Breakpoint[] = [];
  for (const each of breaks.value) {
    if (disabled.value.has(breakKey(each.file, each.line))) continue;
    const addresses = addressesOf(each.file, each.line);
    if (!addresses.length) continue;
    const text = each.condition.trim();
    all.push({
      addresses,
      condition: text ? await compiler().condition(text).catch(tell) : null,
    });
  }
  for (const text of conditions.value) {
    if (disabled.value.has(text)) continue;
    const condition = await compiler().condition(text).catch(tell);
    if (condition) all.push({ addresses: [], condition });
  }
  await chip().breakpoints(all);
}

function tell(fault: unknown): null {
  sayError(fault);
  return null;
}

/** First address of each piece of code that a line made, at every use of a macro. */
export function addressesOf(file: string, line: number): number[] {
  const words = program.value?.words ?? [];
  const here = words.map((word) => word.origins.some((at) => at.file === file && at.line === line));
  return [...here.keys()].filter((at) => here[at] && !here[at - 1]);
}
