/** The camera as a source of live frames. It starts only when the reader chooses it. */

import { signal } from "@preact/signals";
import { openCamera, type Camera, type CameraStats } from "../frames/camera";
import type { ChipClient } from "../protocol";
import { sayError } from "../say";
import { running } from "../store";

/** How well the chip keeps up with the camera; null while that is off. */
export const cameraRate = signal<CameraStats | null>(null);

let camera: Camera | null = null;

/**
 * Turn the camera on, in place of the one that is on.
 *
 * The browser asks the reader, which takes its time: if `isWanted` says no by then, the new stream
 * is stopped at once, and the answer is false. `onEnd` hears if the camera ends by itself. Rejects
 * with a message that says what to do.
 */
export async function cameraOn(
  size: { rows: number; cols: number },
  chip: ChipClient,
  isWanted: () => boolean,
  onEnd: () => void,
): Promise<boolean> {
  const opened = await openCamera(
    size,
    (frame) => (running.value ? chip.feed(frame) : Promise.resolve("dropped" as const)),
    {
      onStats: (stats) => {
        if (camera === opened) cameraRate.value = stats;
      },
      onEnd: (why) => {
        if (camera !== opened) return;
        cameraOff();
        onEnd();
        sayError(why);
      },
    },
  );
  if (!isWanted()) {
    opened.stop();
    return false;
  }
  cameraOff();
  camera = opened;
  return true;
}

export function cameraOff(): void {
  camera?.stop();
  camera = null;
  cameraRate.value = null;
}

export function isCameraOn(): boolean {
  return camera !== null;
}
