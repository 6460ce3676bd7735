/** Where frames come from: bundled clips, own files, a drawn scene, the camera. */

import { signal } from "@preact/signals";
import { bundledClips, loadBundled } from "../frames/bundled";
import { type Fit, SizeError } from "../frames/errors";
import { openFiles } from "../frames/open";
import type { Clip } from "../protocol";
import { clip, compiled, program, progress } from "../store";
import { cameraOff, cameraOn } from "./camera";
import { forget } from "./chip";
import { chip } from "./parts";
import { during, say } from "./say";

/** What the box `Clip` shows: the name of a bundled clip, `own`, `camera`, or nothing. */
export const chosenClip = signal("");
/** The reader's files that need a fit, with what is wrong; null if there are none. */
export const fitQuestion = signal<{ files: File[]; text: string; canCrop: boolean } | null>(null);
export const sceneOpen = signal(false);
/** Stops reading a long file. */
export const cancelReading = signal<(() => void) | null>(null);

export { bundledClips };

/** Size of the frames that the machine takes. */
export function frameSize(): { rows: number; cols: number } {
  const machine = (program.value ?? compiled.value?.program)?.machine;
  return { rows: 8 * (machine?.np_rows ?? 8), cols: 8 * (machine?.np_cols ?? 10) };
}

export async function chooseBundled(name: string): Promise<void> {
  const found = await during(`Fetching ${name}`, () => loadBundled(name, frameSize(), "resize"));
  if (found) await give(found, name);
}

export async function chooseCamera(): Promise<void> {
  const before = clip.value;
  const on = await during("Asking for the camera", async () => {
    await cameraOn(frameSize());
    return true;
  });
  if (!on) {
    clip.value = before;
    chosenClip.value = chosenClip.peek();
    return;
  }
  chosenClip.value = "camera";
  clip.value = "live";
  forget();
  await chip().frames("live");
}

/** Read the reader's own files; ask for a fit if their size is another. */
export async function chooseFiles(files: File[], fit: Fit | null = null): Promise<boolean> {
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
  if (!found) return false;
  await give(found, "own");
  return true;
}

/** Use a clip from now on. */
export async function give(found: Clip, chosen: string): Promise<void> {
  cameraOff();
  forget();
  clip.value = found;
  chosenClip.value = chosen;
  await chip().frames(found);
  say(`${found.name}: ${found.count} frame${found.count === 1 ? "" : "s"} of ${found.rows} × ${found.cols}`);
}
