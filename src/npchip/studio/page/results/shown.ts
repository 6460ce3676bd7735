/** The frame that is shown, and the rate at which panels are drawn. */

import { computed, effect, untracked } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";
import { batches, frameCount, pace, program, running, shownFrame } from "../store";
import type { FrameBatch, ProgramInfo } from "../protocol";
import { type Column, SETUP, columnsOf, firstFrame, isImage } from "./frames";

/** Index of the frame that is shown; -1 for the setup, as long as there is no frame. */
export const shown = computed(() => {
  const newest = frameCount.value - 1;
  if (newest < 0) return SETUP;
  const chosen = shownFrame.value ?? newest;
  return Math.min(newest, Math.max(firstFrame(batches.value), chosen));
});

let known: { program: ProgramInfo | null; first: FrameBatch | undefined; columns: Column[] } | null =
  null;

/** The outputs of the run; the same array as long as new frames bring no new one. */
export const columns = computed(() => {
  const [first] = batches.value;
  const last = batches.value[batches.value.length - 1];
  const grew = known && known.program === program.value && known.first === first;
  if (known && grew && last && hasAll(known.columns, last)) return known.columns;
  const found = columnsOf(program.value, batches.value);
  known = { program: program.value, first, columns: found };
  return found;
});

/** Return whether nothing in a batch is new. */
function hasAll(all: readonly Column[], batch: FrameBatch): boolean {
  for (const name in batch.outputs) {
    const column = all.find((each) => each.name === name);
    if (!column || (isImage(column) && !column.rows)) return false;
  }
  return true;
}

/**
 * Return what `read` makes of signals, at most every `interval` ms while the chip runs.
 *
 * Pictures move with every frame; text that changes faster than it can be read only takes time.
 * At full speed it takes that time from the chip, so the first text waits as well: by then many runs
 * are over. `inputs` are the values of the component that `read` uses.
 */
export function useSlowly<T>(read: () => T, interval: number, inputs: unknown[] = []): T {
  const [value, set] = useState(() => untracked(read));
  useEffect(() => {
    let timer = 0;
    let last = 0;
    let next: T;
    const show = (): void => {
      window.clearTimeout(timer);
      timer = 0;
      last = performance.now();
      const found = next;
      set(() => found);
    };
    const dispose = effect(() => {
      next = read();
      if (!running.value) show();
      else if (!timer) {
        const wait = pace.value === "max" ? interval : last + interval - performance.now();
        if (wait <= 0) show();
        else timer = window.setTimeout(show, wait);
      }
    });
    return () => {
      dispose();
      window.clearTimeout(timer);
    };
  }, inputs);
  return value;
}
