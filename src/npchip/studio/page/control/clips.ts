/** Choosing a clip: the one that was chosen last counts, whichever is there first. */

import { signal } from "@preact/signals";
import { type Fit, type Size, SizeError } from "../frames/errors";
import { openFiles } from "../frames/open";
import type { Clip } from "../protocol";
import { during } from "./jobs";

/** The reader's files that need a fit, with what is wrong; null if there are none. */
export const fitQuestion = signal<{ files: File[]; text: string; canCrop: boolean } | null>(null);

/** Counts what was chosen. */
let choosing = 0;

/** Choose: return a function that tells whether no other clip was chosen since. */
export function clipChoice(): () => boolean {
  const mine = ++choosing;
  return () => choosing === mine;
}

/**
 * Read the reader's own files, which can be cancelled; ask for a fit if their size is another.
 * Null if there is no clip, or if another one was chosen meanwhile.
 */
export async function readClip(files: File[], size: Size, fit: Fit | null): Promise<Clip | null> {
  const isNewest = clipChoice();
  const control = new AbortController();
  fitQuestion.value = null;
  const found = await during(
    "Reading the clip",
    async (job) => {
      try {
        return await openFiles(files, size, fit, (share) => job.tell(share), control.signal);
      } catch (fault) {
        if (!(fault instanceof SizeError) || fit) throw fault;
        if (isNewest()) fitQuestion.value = { files, text: fault.message, canCrop: fault.croppable };
        return null;
      }
    },
    () => control.abort(),
  );
  return isNewest() ? found : null;
}
