/** Long work that the status line shows. Several jobs may be at work; the newest is shown. */

import { sayError } from "../say";
import { progress, type Work } from "../store";

/** The end of a job that its work holds. */
export interface Job {
  /** Say how far it is, 0 to 1 or null if unknown, and what it does now. */
  tell(share: number | null, text?: string): void;
  /** Show it no more. What other jobs show stays. */
  end(): void;
}

const jobs: Work[] = [];

function show(): void {
  progress.value = jobs.at(-1) ?? null;
}

/** Show a job until it ends; `cancel` stops it. */
export function begin(text: string, cancel: (() => void) | null = null): Job {
  let mine: Work = { text, share: null, cancel };
  jobs.push(mine);
  show();
  return {
    tell(share, now = mine.text) {
      const at = jobs.indexOf(mine);
      if (at < 0) return;
      mine = { ...mine, text: now, share };
      jobs[at] = mine;
      show();
    },
    end() {
      const at = jobs.indexOf(mine);
      if (at >= 0) jobs.splice(at, 1);
      show();
    },
  };
}

/** Show that something takes long while `work` runs, and an error if it fails. */
export async function during<T>(
  text: string,
  work: (job: Job) => Promise<T>,
  cancel: (() => void) | null = null,
): Promise<T | null> {
  const job = begin(text, cancel);
  try {
    return await work(job);
  } catch (fault) {
    sayError(fault);
    return null;
  } finally {
    job.end();
  }
}
