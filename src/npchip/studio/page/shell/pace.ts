/** The rate of frames. */

import { signal } from "@preact/signals";
import type { Pace } from "../protocol";
import { clip, pace } from "../store";

/** True if clips run at the rate that their file states, where it states one. */
export const asClip = signal(false);

/** Frames a second of cameras; one that is asked for about as many. */
const CAMERA = 30;

/** Frames a second that the clip's file states; null if it states none, and for the camera. */
export function clipRate(): number | null {
  const now = clip.value;
  return now === null || now === "live" ? null : now.fps;
}

/**
 * The pace that the chip gets. Decision: a camera sets its own pace. A limit of as many frames as it
 * gives would drop some, as two clocks never agree; a lower one, to look more closely, holds.
 */
export function paceNow(): Pace {
  const chosen = pace.value;
  if (clip.value === "live") {
    return chosen !== "max" && chosen.unit === "frames" && chosen.rate >= CAMERA ? "max" : chosen;
  }
  const rate = asClip.value ? clipRate() : null;
  return rate === null ? chosen : { unit: "frames", rate };
}
