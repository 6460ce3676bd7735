/** Making a chip rest, even one that hears nothing. */

import type { ChipClient } from "../protocol";

/** A chip that does not stop within this time is ended, in milliseconds. */
const PATIENCE = 1500;

/** Counts pauses: each gives the chip time of its own. */
let pauses = 0;

/** Pause the chip. If it is `isDue` then still, it is ended, and `ended` is called. */
export function restSoon(chip: ChipClient, isDue: () => boolean, ended: () => void): void {
  chip.pause();
  const mine = ++pauses;
  setTimeout(() => {
    if (mine !== pauses || !isDue()) return;
    chip.terminate();
    ended();
  }, PATIENCE);
}

/** The pause that made way for other work was heard: that may take as long as it likes. */
export function restHeard(): void {
  pauses += 1;
}
