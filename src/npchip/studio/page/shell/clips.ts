/** Where frames come from: bundled clips, own files, a drawn scene, the camera. */

import { signal } from "@preact/signals";
import { bundledClips, loadBundled } from "../frames/bundled";
import { type Fit, SizeError } from "../frames/errors";
import { openFiles } from "../frames/open";
import type { Clip } from "../protocol";
import { clip, compiled, program, progress } from "../store";
import { cameraOff, cameraOn, isCameraOn } from "./camera";
import { halt, pause, run, unlessRest } from "./chip";
import { chip } from "./parts";
import { during, say, sayError } from "./say";

/** What the box `Clip` shows: the name of a bundled clip, `own`, `scene`, `camera`, or nothing. */
export const chosenClip = signal("");
/** The reader's files that need a fit, with what is wrong; null if there are none. */
export const fitQuestion = signal<{ files: File[]; text: string; canCrop: boolean } | null>(null);
export const sceneOpen = signal(false);
/** Stops reading a long file. */
export const cancelReading = signal<(() => void) | null>(null);

/** Counts what was chosen: of clips that are read at a time the one chosen last counts. */
let choosing = 0;

export { bundledClips };

/** Choose: return a function that tells whether no other clip was chosen since. */
export function clipChoice(): () => boolean {
  const mine = ++choosing;
  return () => choosing === mine;
}

/** Size of the frames that the machine takes. */
export function frameSize(): { rows: number; cols: number } {
  const machine = (program.value ?? compiled.value?.program)?.machine;
  return { rows: 8 * (machine?.np_rows ?? 8), cols: 8 * (machine?.np_cols ?? 10) };
}

/** True if the clip is one of those that come with the page. */
export function isBundled(): boolean {
  return !["", "own", "scene", "camera"].includes(chosenClip.value);
}

export async function chooseBundled(name: string): Promise<void> {
  const isNewest = clipChoice();
  const found = await during(`Fetching ${name}`, () => loadBundled(name, frameSize(), "resize"));
  if (found && isNewest()) await give(found, name);
}

/** Run, with the camera on if that is the clip: it may have been unplugged. */
export async function start(): Promise<void> {
  if (clip.value === "live" && !isCameraOn()) await chooseCamera();
  else await run();
}

/** Turn the camera on and run, as whoever chooses a camera wants to see what it sees. */
export async function chooseCamera(): Promise<void> {
  const isNewest = clipChoice();
  const on = await during("Waiting for the camera: allow it if the browser asks", async () => {
    await cameraOn(frameSize(), pause);
    return true;
  });
  if (!on) return;
  if (!isNewest()) {
    if (clip.value !== "live") cameraOff();
    return;
  }
  await halt();
  chosenClip.value = "camera";
  clip.value = "live";
  await chip().frames("live");
  await run();
  say("The camera is on. Its pictures stay in this browser");
}

/** Turn the camera off. What it has shown stays. */
export async function leaveCamera(): Promise<void> {
  cameraOff();
  await halt();
  say("The camera is off. Run turns it on again");
}

/** Read the reader's own files; ask for a fit if their size is another. */
export async function chooseFiles(files: File[], fit: Fit | null = null): Promise<void> {
  const isNewest = clipChoice();
  const control = new AbortController();
  fitQuestion.value = null;
  cancelReading.value = () => control.abort();
  const found = await during("Reading the clip", async () => {
    try {
      return await openFiles(
        files,
        frameSize(),
        fit,
        (share) => {
          progress.value = { text: "Reading the clip", share };
        },
        control.signal,
      );
    } catch (fault) {
      if (!(fault instanceof SizeError) || fit) throw fault;
      fitQuestion.value = { files, text: fault.message, canCrop: fault.croppable };
      return null;
    }
  });
  cancelReading.value = null;
  if (found && isNewest()) await give(found, "own");
}

/** Use a clip from now on; a chip that ran goes on with it. */
export async function give(found: Clip, chosen: string): Promise<void> {
  const isNewest = clipChoice();
  const goesOn = unlessRest();
  cameraOff();
  const ran = await halt();
  if (!isNewest()) return;
  clip.value = found;
  chosenClip.value = chosen;
  await chip().frames(found);
  if (ran && goesOn()) await run();
  const frames = `${found.count} frame${found.count === 1 ? "" : "s"} of ${found.rows} × ${found.cols}`;
  say(`${found.name}: ${frames}${ran ? "" : ". Press Run"}`);
}

/** Read a bundled clip or the camera again if the machine takes frames of another size. */
export async function refit(): Promise<void> {
  const size = frameSize();
  const now = clip.peek();
  if (now === "live") {
    if (isCameraOn()) await cameraOn(size, pause).catch(sayError);
  } else if (now && (now.rows !== size.rows || now.cols !== size.cols)) {
    if (isBundled()) await chooseBundled(chosenClip.peek());
    else {
      await halt();
      clip.value = null;
      chosenClip.value = "";
      await chip().frames(null);
      sayError(new Error(`This machine takes frames of ${size.rows} × ${size.cols}: open your clip again, or another`));
    }
  }
}
