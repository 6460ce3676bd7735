/** Runs, steps and what the chip tells of them. */

import { batch, signal } from "@preact/signals";
import type { Breakpoint, ChipEvents, ChipView, Compiled, CompileRequest, FrameBatch, Pace, ProgramInfo, Stop, Travel } from "../protocol";
import { restHeard, restSoon } from "../control/rest";
import { searchIsAt, showSearch } from "../control/search";
import { trim } from "../results/trim";
import {
  batches,
  breakKey,
  breaks,
  clip,
  conditions,
  disabled,
  frameCount,
  library,
  pace,
  program,
  project,
  running,
  shownFrame,
  stop,
  view,
} from "../store";
import { heard, problem, putAway, say, sayError } from "../say";
import { compileNow, originOf } from "./compile";
import { exchanged, pictureCame } from "./marks";
import { paceNow } from "./pace";
import { chip, compiler, loading } from "./parts";
import { addressesOf } from "./places";
import { complete, stepNow } from "./stepping";

/** The default of `npchip run`. */
const MAX_CYCLES = 50_000_000;

/** The start of the message if the program has mistakes. */
const CANNOT_RUN = "The program cannot run yet";

/** True if a clip starts again at its end. */
export const repeat = signal(false);

/** The module in the chip; null if there is none, or if it was ended. */
let inChip: Compiled["module"] = null;
/** True from Run to Pause; a clip that is repeated rests in between. */
let wanted = false;
/** The last reset: a run that is asked for meanwhile begins after it. */
let rewound: Promise<void> = Promise.resolve();
/** Counts starts, and what calls a start off that waits for the compiler. */
let starts = 0;

/** Counts how often the chip began anew. */
let begins = 0;
/** Counts what asks for rest: Pause and Reset. */
let rests = 0;
/** The newest program on its way into the chip. */
let putting: Promise<void> = Promise.resolve();
/** Counts lists of breakpoints that were asked for. */
let settings = 0;

export const events: ChipEvents = {
  begun(): void {
    begins += 1;
    wanted = false;
    running.value = false;
    forget();
  },
  frames(part: FrameBatch): void {
    batches.value = trim([...batches.value, part]);
    if (part.cycles.length) pictureCame();
  },
  view(seen: ChipView): void {
    view.value = seen;
  },
  stopped(why: Stop): void {
    const isOver = why.reason === "ended" && view.value?.status === "frames-exhausted";
    if (isOver && repeat.value && wanted && clip.value !== "live" && frameCount.value > 0) heard(again());
    else stopped(why);
  },
  progress: searchIsAt,
  failed(text: string): void {
    wanted = false;
    running.value = false;
    inChip = null; // the next run puts the program into another chip
    sayError(new Error(text));
  },
};

function stopped(why: Stop): void {
  wanted = false;
  batch(() => {
    running.value = false;
    stop.value = why;
  });
  const seen = view.value;
  if (why.reason === "ended" && seen?.status === "failed" && seen.error) {
    sayError(new Error(`The program failed ${whereText(seen.error.address)}: ${plain(seen.error.message)}`));
  } else if (why.reason === "ended" && seen?.status === "cycle-limit") {
    sayError(new Error(`A frame took more than ${MAX_CYCLES.toLocaleString("en")} cycles. Is the program stuck in a loop?`));
  } else if (why.reason === "ended") say(endText(seen));
  else say(why.text);
}

/** Name the line that made an instruction. */
function whereText(address: number): string {
  const at = program.value?.words[address]?.origins[0];
  return at ? `in ${at.file}, line ${at.line}` : `at address ${address}`;
}

/** A message without the address that it begins with: the place was said already. */
function plain(message: string): string {
  return message.replace(/^at address \d+: /, "");
}

/** Say how a run has ended, and what gives it more to do. */
function endText(seen: ChipView | null): string {
  const count = frameCount.value;
  if (seen?.status === "halted" && !count) return "The program halted without taking a frame";
  const frames = `after ${count} frame${count === 1 ? "" : "s"}`;
  if (seen?.status === "halted") return `The program halted ${frames}`;
  if (clip.value === null) return "The program waits for a frame: choose a clip, or the camera";
  return `End of the clip ${frames}. Press Run to start again, or look back with the slider under the picture`;
}

/** Let a clip start again, unless Pause is pressed on the way. */
async function again(): Promise<void> {
  const begun = batch(() => {
    const done = chip().reset();
    wanted = running.value = true; // to the reader it goes on
    return done;
  });
  await begun;
  if (wanted) chip().run(paceNow());
  else running.value = false;
}

/** Put the newest program into the chip, unless it is there. False if it has mistakes. */
export async function bringUp(): Promise<boolean> {
  const newest = await compileNow();
  if (!newest) return false;
  if (!newest.program || !newest.module) {
    const [first, ...others] = newest.diagnostics.filter((each) => each.severity === "error");
    const more = others.length ? `, and ${others.length} more below the program` : "";
    sayError(new Error(`${CANNOT_RUN}: ${first?.message ?? "it has mistakes"}${more}`));
    return false;
  }
  if (newest.module !== inChip) putting = put(newest);
  await putting;
  // Another one may have come in the meantime.
  return newest.module === inChip || bringUp();
}

/** Return the source of the program in the chip; null if there is none. */
export function origin(): CompileRequest | null {
  return originOf(inChip);
}

/** Take back what was said of mistakes that are mended. */
export function mended(): void {
  if (!problem.value.startsWith(CANNOT_RUN)) return;
  putAway();
  say("All mistakes are fixed: press Run");
}

/** Put a program into the chip. What the old one has shown goes. */
async function put(made: Compiled): Promise<void> {
  if (!made.program || !made.module) return;
  inChip = made.module;
  try {
    await chip().load(made.module.slice(), made.program, MAX_CYCLES);
  } catch (fault) {
    if (inChip === made.module) inChip = null;
    throw fault;
  }
  if (inChip !== made.module) return;
  heard(complete(made.module, () => inChip === made.module));
  program.value = made.program;
  await setBreaks();
}

/** Exchange the program of a chip that runs for one that was edited at a time. */
export async function exchange(made: Compiled, editedAt: number): Promise<void> {
  if (!running.value || !made.module || made.module === inChip) return;
  const goesOn = unlessRest();
  putting = put(made);
  await putting;
  exchanged(editedAt);
  if (goesOn()) await run();
}

/** Return a function that tells whether neither Pause nor Reset was pressed since. */
export function unlessRest(): () => boolean {
  const before = rests;
  return () => rests === before;
}

/** Forget the outputs of a run. */
function forget(): void {
  batch(() => {
    batches.value = [];
    shownFrame.value = null;
    stop.value = null;
  });
}

export async function run(): Promise<void> {
  const mine = ++starts;
  await rewound;
  if (running.value && !wanted) await rested(); // a step back, or what Pause stops, ends first
  if (mine !== starts) return;
  if (loading.value) say("The program will run as soon as the assembler has loaded");
  if (!(await bringUp()) || mine !== starts || running.value) return;
  if (view.value?.ended) await rewind();
  // Something else may have been asked for while it was put back.
  if (mine !== starts || running.value) return;
  wanted = true;
  running.value = true;
  say("Running");
  if (pace.value !== "max" || breaks.value.length || conditions.value.length) stepNow();
  chip().run(paceNow());
}

/** Run at another speed from now on. */
export async function changePace(chosen: Pace): Promise<void> {
  pace.value = chosen;
  const goesOn = unlessRest();
  if ((await halt()) && goesOn()) await run();
}

/** Stop, even a chip that hears nothing; then the program is put in again. */
export function pause(): void {
  rests += 1;
  rest();
}

function rest(): void {
  wanted = false;
  starts += 1;
  if (!running.value) return;
  const isDue = (): boolean => running.value && !wanted;
  restSoon(chip(), isDue, () => {
    running.value = false;
    inChip = null;
    sayError(new Error("The chip did not answer and was stopped. Your program is kept: press Run to start again"));
  });
}

/** Pause, and wait until the chip rests. Return whether it ran. */
export async function halt(): Promise<boolean> {
  if (!running.value) return false;
  rest();
  await rested();
  return true;
}

/** Wait until the chip rests. */
function rested(): Promise<void> {
  return new Promise((resolve) => {
    const end = running.subscribe((still) => {
      if (still) return;
      resolve();
      queueMicrotask(() => end());
    });
  });
}

export async function reset(): Promise<void> {
  starts += 1;
  rests += 1;
  const done = rewind();
  rewound = done.catch(() => undefined);
  await done;
  say("Reset: the next instruction is the first one");
}

async function rewind(): Promise<void> {
  await halt();
  forget();
  const before = inChip;
  await bringUp();
  // A program that was just put in is at its beginning. With mistakes in the text it is the old one.
  if (!inChip || inChip !== before) return;
  await chip().reset();
}

export async function go(travel: Travel, back: boolean): Promise<void> {
  await halt();
  if (await bringUp()) await move(travel, back);
}

/** Go to a line, or back to it. Return why there is no such way; null if there is. */
export async function goToLine(file: string, line: number, back: boolean): Promise<string | null> {
  await halt();
  // Before, another program may be in the chip, with other addresses.
  if (!(await bringUp()) || !program.value) return null;
  const addresses = addressesAt(program.value, file, line);
  if (!addresses.length) return "Put the editor's cursor on a line with an instruction first.";
  await move({ to: "cursor", addresses }, back);
  return null;
}

async function move(travel: Travel, back: boolean): Promise<void> {
  if (view.value?.ended && !back) {
    say("The run has ended: press Reset, or step back");
    return;
  }
  running.value = true;
  stepNow();
  restHeard();
  const searched = showSearch("Searching back through the run", pause);
  const before = begins;
  try {
    const why = await chip().go(travel, back);
    if (before === begins) stopped(why);
  } catch (fault) {
    if (before === begins) running.value = false;
    sayError(fault);
  } finally {
    searched();
  }
}

/** Give the chip the breakpoints of lines and the conditions; each that cannot be read is told. */
export async function setBreaks(): Promise<void> {
  const mine = ++settings;
  const made = program.value;
  if (!made) return;
  const all: Breakpoint[] = [];
  for (const each of breaks.value) {
    if (disabled.value.has(breakKey(each.file, each.line))) continue;
    const addresses = addressesAt(made, each.file, each.line);
    if (!addresses.length) continue;
    const text = each.condition.trim();
    all.push({ addresses, condition: text ? await read(text) : null });
  }
  for (const text of conditions.value) {
    if (disabled.value.has(text)) continue;
    const condition = await read(text);
    if (condition) all.push({ addresses: [], condition });
  }
  // Reading conditions takes a while: a newer list, or that of a newer program, counts.
  if (mine === settings) await chip().breakpoints(all);
}

/** Read a condition for the present program; one that cannot be read is told and left out. */
async function read(text: string): Promise<Breakpoint["condition"]> {
  try {
    const about = origin();
    return about && (await compiler().condition(text, about));
  } catch (fault) {
    sayError(fault);
    return null;
  }
}

function addressesAt(made: ProgramInfo, file: string, line: number): number[] {
  const text = project.value.files[file] ?? library.value[file];
  return addressesOf(made, origin(), file, text, line);
}
