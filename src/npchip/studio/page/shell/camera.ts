/** The camera as a source of live frames. It starts only when the reader chooses it. */

import { signal } from "@preact/signals";
import { openCamera, type Camera, type CameraStats } from "../frames/camera";
import { running } from "../store";
import { chip } from "./parts";
import { say, sayError } from "./say";

/** How well the chip keeps up with the camera; null while that is off. */
export const cameraRate = signal<CameraStats | null>(null);

let camera: Camera | null = null;

/** Turn the camera on. Rejects with a message that says what to do. */
export async function cameraOn(size: { rows: number; cols: number }): Promise<void> {
  cameraOff();
  camera = await openCamera(
    size,
    (frame) => (running.value ? chip().feed(frame) : Promise.resolve("dropped" as const)),
    {
      onStats: (stats) => {
        cameraRate.value = stats;
      },
      onEnd: (why) => {
        cameraOff();
        sayError(why);
      },
    },
  );
  say("The camera is on. Its pictures stay in this browser");
}

export function cameraOff(): void {
  camera?.stop();
  camera = null;
  cameraRate.value = null;
}
