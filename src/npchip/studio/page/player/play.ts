/** Runs the program of the page: the chip, its frames, and what it tells. */

import { batch, signal } from "@preact/signals";
import { type Actions, provide } from "../actions";
import { openCamera, type Camera } from "../frames/camera";
import { type Fit, type FramesError, SizeError } from "../frames/errors";
import { openFiles } from "../frames/open";
import { createChip } from "../machine/client";
import type { ChipClient, ChipView, Clip, FrameBatch, Pace, Stop, Travel } from "../protocol";
import { trim } from "../results/trim";
import { batches, clip, message, pace, program, progress, running, shownFrame, view } from "../store";
import { readData, startWorker, type Exported } from "./data";

/** Time after which a chip that does not stop is ended, in milliseconds. */
const PATIENCE = 1500;

/** What the page holds; null until it is read. */
export const exported = signal<Exported | null>(null);
/** The source of frames: `page`, `file`, `camera`, or none. */
export const source = signal<"" | "page" | "file" | "camera">("");
/** Files of another size than the sensor's, and what is wrong with it. */
export const misfit = signal<{ files: File[]; error: SizeError } | null>(null);

let chip: ChipClient | null = null;
let camera: Camera | null = null;
/** Counts runs: a pause gives up only the one that it was meant for. */
let starts = 0;

/** Read the page's data, and show its first frames unless the reader wants no motion. */
export async function open(): Promise<void> {
  provideActions();
  await during("Unpacking the program", async () => {
    const data = await readData();
    document.title = data.title;
    exported.value = data;
    chip = createChip(startWorker, events);
    await load();
    if (!data.clip) {
      say(data.program.exposes ? "Choose a clip or the camera, then press Run" : "Press Run");
      return;
    }
    await give(data.clip, "page");
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) say("Press Run");
    else run();
  });
}

async function load(): Promise<void> {
  const data = exported.value;
  if (!data || !chip) return;
  await chip.load(data.module.slice(), data.program, data.maxCycles);
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
  progress(share: number): void {
    progress.value = { text: "Going there", share };
  },
  failed(text: string): void {
    running.value = false;
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
  progress.value = null;
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

export function run(): void {
  void during("", async () => {
    if (view.value?.ended) await reset();
    if (!source.value && program.value?.exposes) {
      throw new Error("The program takes frames: choose a clip or the camera first");
    }
    running.value = true;
    starts += 1;
    say("Running");
    chip?.run(source.value === "camera" ? "max" : pace.value);
  });
}

export function pause(): void {
  chip?.pause();
  const mine = starts;
  setTimeout(() => {
    if (!running.value || mine !== starts) return;
    running.value = false;
    chip?.terminate();
    void during("Starting again", async () => {
      await load();
      if (clip.value) await chip?.frames(clip.value);
      throw new Error("The program did not answer, so it was stopped and loaded again");
    });
  }, PATIENCE);
}

export async function reset(): Promise<void> {
  await chip?.reset();
}

export function go(travel: Travel, back = false): void {
  if (running.value || (view.value?.ended && !back)) return;
  void during("", async () => {
    running.value = true;
    try {
      const why = await chip?.go(travel, back);
      if (why) stopped(why);
    } finally {
      running.value = false;
    }
  });
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
export function choosePage(): void {
  const own = exported.value?.clip;
  if (own) void during("", () => give(own, "page"));
}

/** Read the reader's files; where their size is another, ask what to do. */
export function chooseFiles(files: File[], fit: Fit | null = null): void {
  misfit.value = null;
  void during("Reading the clip", async () => {
    try {
      const told = (share: number | null): void => {
        progress.value = { text: "Reading the clip", share };
      };
      const found = await openFiles(files, frameSize(), fit, told, new AbortController().signal);
      await give(found, "file");
      say(`${found.name}: ${found.count} frames. Press Run`);
    } catch (fault) {
      if (!(fault instanceof SizeError) || fit) throw fault;
      misfit.value = { files, error: fault };
    }
  });
}

/** Turn the camera on, which the browser asks the reader about. */
export function chooseCamera(): void {
  void during("Asking for the camera", async () => {
    cameraOff();
    const feed = (frame: Uint8Array<ArrayBuffer>): Promise<"done" | "dropped"> =>
      chip && running.value ? chip.feed(frame) : Promise.resolve("dropped");
    camera = await openCamera(frameSize(), feed, { onEnd: cameraEnded });
    source.value = "camera";
    clip.value = "live";
    await chip?.frames("live");
    run();
  });
}

function cameraEnded(why: FramesError): void {
  cameraOff();
  sayError(why);
}

function cameraOff(): void {
  camera?.stop();
  camera = null;
  if (source.value !== "camera") return;
  source.value = "";
  clip.value = null;
}

function frameSize(): { rows: number; cols: number } {
  const size = exported.value?.program.machine;
  return { rows: 8 * (size?.np_rows ?? 8), cols: 8 * (size?.np_cols ?? 10) };
}

// ---- telling

export function say(text: string): void {
  message.value = { kind: "info", text };
}

function sayError(fault: unknown): void {
  message.value = { kind: "error", text: fault instanceof Error ? fault.message : String(fault) };
}

async function during(text: string, work: () => Promise<void>): Promise<void> {
  if (text) progress.value = { text, share: null };
  try {
    await work();
  } catch (fault) {
    running.value = false;
    sayError(fault);
  } finally {
    progress.value = null;
  }
}

/** The pictures and the table ask for these only; the rest of the studio is not here. */
function provideActions(): void {
  const own: Partial<Actions> = {
    showFrame(index) {
      shownFrame.value = index;
    },
    save,
  };
  provide(own as Actions);
}

function save(name: string, data: BlobPart, type: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([data], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
