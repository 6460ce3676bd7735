/** The camera as a source of live frames. It starts only when the reader chooses it. */

import { signal } from "@preact/signals";
import { openCamera, type Camera, type CameraStats } from "../frames/camera";
import { running } from "../store";
import { chip } from "./parts";
import { sayError } from "./say";

/** How well the chip keeps up with the camera; null while that is off. */
export const cameraRate = signal<CameraStats | null>(null);

let camera: Camera | null = null;

/** Turn the camera on; `onEnd` hears if it ends by itself. Rejects with a message that says what to do. */
export async function cameraOn(size: { rows: number; cols: number }, onEnd: () => void): Promise<void> {
  const opened = await openCamera(
    size,
    (frame) => (running.value ? chip().feed(frame) : Promise.resolve("dropped" as const)),
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
  cameraOff();
  camera = opened;
}

export function cameraOff(): void {
  camera?.stop();
  camera = null;
  cameraRate.value = null;
}

export function isCameraOn(): boolean {
  return camera !== null;
}
