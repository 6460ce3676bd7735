/** The speeds to choose from, from one instruction a second to as fast as it goes. */

import type { Pace } from "../protocol";

export const PACES: readonly (readonly [string, Pace])[] = [
  ["1 step a second", { unit: "steps", rate: 1 }],
  ["5 steps a second", { unit: "steps", rate: 5 }],
  ["50 steps a second", { unit: "steps", rate: 50 }],
  ["1 frame a second", { unit: "frames", rate: 1 }],
  ["5 frames a second", { unit: "frames", rate: 5 }],
  ["15 frames a second", { unit: "frames", rate: 15 }],
  ["30 frames a second", { unit: "frames", rate: 30 }],
  ["As fast as it goes", "max"],
];

/** The speeds without those that follow single instructions. */
export const FRAME_PACES = PACES.filter(([, pace]) => pace === "max" || pace.unit === "frames");

/** Place of a speed in a list of them; -1 if it is not there. */
export function paceIndex(all: typeof PACES, pace: Pace): number {
  return all.findIndex(([, each]) => JSON.stringify(each) === JSON.stringify(pace));
}
