/** The camera as a source of live frames. It starts only when the reader chooses it. */

import { signal } from "@preact/signals";
import { listCameras, openCamera, type Camera, type CameraStats } from "../frames/camera";
import type { ChipClient } from "../protocol";
import { heard, sayError } from "../say";
import { running } from "../store";

/** The rate at which the chip keeps up with the camera; null while that is off. */
export const cameraRate = signal<CameraStats | null>(null);

/** The cameras to choose from, where there are several; browsers name them once one was allowed. */
export const cameras = signal<{ deviceId: string; label: string }[]>([]);

let camera: Camera | null = null;

/**
 * Turn the camera on instead of the one that is on: a certain one, or any for null.
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
  deviceId: string | null = null,
): Promise<boolean> {
  const opened = await openCamera(
    size,
    (frame) => (running.value ? chip.feed(frame) : Promise.resolve("dropped" as const)),
    {
      ...(deviceId === null ? {} : { deviceId }),
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
  heard(lookForCameras());
  return true;
}

/** List the cameras; without a list the browser's own choice is as good as any. */
async function lookForCameras(): Promise<void> {
  const found = await listCameras().catch(() => []);
  cameras.value = found.length > 1 ? found : [];
}

export function cameraOff(): void {
  camera?.stop();
  camera = null;
  cameraRate.value = null;
}

export function isCameraOn(): boolean {
  return camera !== null;
}
