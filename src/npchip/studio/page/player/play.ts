/** Runs the program of the page: the chip, its frames, and what it tells. */

import { batch, signal } from "@preact/signals";
import { type Actions, provide } from "../actions";
import { cameraOff, cameraOn } from "../control/camera";
import { clipChoice, readClip } from "../control/clips";
import { during } from "../control/jobs";
import { restSoon } from "../control/rest";
import { offer } from "../control/save";
import { searchIsAt, showSearch } from "../control/search";
import type { Fit } from "../frames/errors";
import { createChip } from "../machine/client";
import type { ChipClient, ChipView, Clip, FrameBatch, Pace, Stop, Travel } from "../protocol";
import { trim } from "../results/trim";
import { say, sayError } from "../say";
import { guide } from "../results/guide";
import { batches, clip, pace, program, running, shownFrame, view } from "../store";
import { readData, startWorker, type Exported } from "./data";

/** Contents of the page; null until they are read. */
export const exported = signal<Exported | null>(null);
/** The source of frames: `page`, `file`, `camera`, or none. */
export const source = signal<"" | "page" | "file" | "camera">("");

let chip: ChipClient | null = null;
/** False if the program has to be put into the chip again, as that was ended or has failed. */
let isLoaded = false;
/** Counts runs: a pause gives up only the one that it was meant for. */
let starts = 0;

/** Read the page's data, and show its first frames unless the reader wants no motion. */
export async function open(): Promise<void> {
  provideActions();
  await during("Unpacking the program", async () => {
    const data = await readData();
    document.title = data.title;
    exported.value = data;
    guide.value = data.guide;
    chip = createChip(startWorker, events);
    await load();
    if (!data.clip) {
      say(data.program.exposes ? "Choose a clip or the camera, then press Run" : "Press Run");
      return;
    }
    await give(data.clip, "page");
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) say("Press Run");
    else await run();
  });
}

async function load(): Promise<void> {
  const data = exported.value;
  if (!data || !chip) return;
  await chip.load(data.module.slice(), data.program, data.maxCycles);
  isLoaded = true;
  program.value = data.program;
}

const events = {
  frames(part: FrameBatch): void {
    batches.value = trim([...batches.value, withInput(part)]);
  },
  view(seen: ChipView): void {
    view.value = seen;
  },
  begun(): void {
    running.value = false;
    forget();
  },
  stopped,
  progress: searchIsAt,
  failed(text: string): void {
    running.value = false;
    isLoaded = false;
    sayError(new Error(text));
  },
};

/** The chip sends live frames back, but not those of a clip, which are here. */
function withInput(part: FrameBatch): FrameBatch {
  const from = clip.value;
  if (part.frames || !from || from === "live") return part;
  const size = from.rows * from.cols;
  const end = part.first + part.cycles.length;
  return { ...part, frames: from.data.subarray(part.first * size, end * size) };
}

function stopped(why: Stop): void {
  running.value = false;
  const seen = view.value;
  if (why.reason === "ended" && seen?.error) {
    const { address, message: text, code } = seen.error;
    sayError(new Error(`The program failed at address ${address}: ${text} [${code}]`));
  } else if (why.reason === "ended" && seen?.status === "cycle-limit") {
    const limit = exported.value?.maxCycles.toLocaleString("en");
    sayError(new Error(`A frame took more than ${limit} cycles, so the run was stopped`));
  } else if (why.reason === "ended") {
    say(seen?.status === "halted" ? "The program has halted" : "End of the clip");
  } else say(why.text);
}

// ---- running

export async function run(): Promise<void> {
  if (!isLoaded) await load();
  if (view.value?.ended) await reset();
  if (!source.value && program.value?.exposes) {
    throw new Error("The program takes frames: choose a clip or the camera first");
  }
  running.value = true;
  starts += 1;
  say("Running");
  chip?.run(source.value === "camera" ? "max" : pace.value);
}

export function pause(): void {
  const mine = starts;
  if (!chip) return;
  restSoon(
    chip,
    () => running.value && mine === starts,
    () => {
      running.value = false;
      isLoaded = false;
      sayError(new Error("The program did not answer and was stopped: press Run to start again"));
    },
  );
}

export async function reset(): Promise<void> {
  if (isLoaded) await chip?.reset();
  else await load();
}

export async function go(travel: Travel, back = false): Promise<void> {
  if (running.value || (view.value?.ended && !back)) return;
  if (!isLoaded) await load();
  running.value = true;
  starts += 1;
  const searched = showSearch("Searching back through the run", pause);
  try {
    const why = await chip?.go(travel, back);
    if (why) stopped(why);
  } finally {
    searched();
    running.value = false;
  }
}

export function setPace(chosen: Pace): void {
  pace.value = chosen;
  if (running.value) chip?.run(chosen);
}

function forget(): void {
  batch(() => {
    batches.value = [];
    shownFrame.value = null;
  });
}

// ---- frames

async function give(found: Clip, kind: "page" | "file"): Promise<void> {
  cameraOff();
  clip.value = found;
  source.value = kind;
  await chip?.frames(found);
}

/** Go back to the clip that came with the page. */
export async function choosePage(): Promise<void> {
  clipChoice();
  const own = exported.value?.clip;
  if (own) await give(own, "page");
}

/** Read the reader's files; where their size is another, ask what to do. */
export async function chooseFiles(files: File[], fit: Fit | null = null): Promise<void> {
  const found = await readClip(files, frameSize(), fit);
  if (!found) return;
  await give(found, "file");
  say(`${found.name}: ${found.count} frames. Press Run`);
}

/** Turn the camera on, which the browser asks the reader about. */
export async function chooseCamera(): Promise<void> {
  if (!chip) return;
  const given = chip;
  const isNewest = clipChoice();
  const on = await during("Waiting for the camera: allow it if the browser asks", () =>
    cameraOn(frameSize(), given, isNewest, cameraEnded),
  );
  if (!on) return;
  source.value = "camera";
  clip.value = "live";
  await given.frames("live");
  if (isNewest()) await run();
}

/** The camera has ended by itself. */
function cameraEnded(): void {
  if (source.value !== "camera") return;
  source.value = "";
  clip.value = null;
  pause();
}

function frameSize(): { rows: number; cols: number } {
  const size = exported.value?.program.machine;
  return { rows: 8 * (size?.np_rows ?? 8), cols: 8 * (size?.np_cols ?? 10) };
}

/** The pictures and the table ask for these only; the rest of the studio is not here. */
function provideActions(): void {
  const own: Partial<Actions> = {
    showFrame(index) {
      shownFrame.value = index;
    },
    save: offer,
  };
  provide(own as Actions);
}
