/** Sources of frames: bundled clips, own files, a drawn scene, the camera. */

import { computed, signal } from "@preact/signals";
import { bundledClips, loadBundled } from "../frames/bundled";
import { cameraOff, cameraOn, isCameraOn } from "../control/camera";
import { clipChoice, readClip } from "../control/clips";
import { during } from "../control/jobs";
import type { Fit } from "../frames/errors";
import type { Clip } from "../protocol";
import { say, sayError } from "../say";
import { clip, compiled, program } from "../store";
import { halt, pause, run, unlessRest } from "./chip";
import { chip } from "./parts";

/** Choice in the box `Clip`: the name of a bundled clip, `own`, `scene`, `camera`, or nothing. */
export const chosenClip = signal("");
/** The camera that the reader has chosen, where there are several; null for any. */
const usedCamera = signal<string | null>(null);
/** Value of the box `Clip`: as `chosenClip`, or the camera's. */
export const boxValue = computed(() =>
  chosenClip.value === "camera" && usedCamera.value !== null ? `camera:${usedCamera.value}` : chosenClip.value,
);
export const sceneOpen = signal(false);
export { bundledClips };

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
  if (clip.value === "live" && !isCameraOn()) await chooseCamera(usedCamera.peek());
  else await run();
}

/** Turn the camera on and run, as whoever chooses a camera wants to see what it sees. */
export async function chooseCamera(deviceId: string | null = null): Promise<void> {
  const isNewest = clipChoice();
  const on = await during("Waiting for the camera: allow it if the browser asks", () =>
    cameraOn(frameSize(), chip(), isNewest, pause, deviceId),
  );
  if (!on) return;
  await halt();
  if (!isNewest()) {
    if (clip.value !== "live") cameraOff();
    return;
  }
  chosenClip.value = "camera";
  usedCamera.value = deviceId;
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

/** Read the reader's own files and use them; ask for a fit if their size is another. */
export async function chooseFiles(files: File[], fit: Fit | null = null): Promise<void> {
  const found = await readClip(files, frameSize(), fit);
  if (found) await give(found, "own");
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
    const isWanted = (): boolean => clip.peek() === "live" && isCameraOn();
    if (isCameraOn()) await cameraOn(size, chip(), isWanted, pause, usedCamera.peek()).catch(sayError);
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
