/** Progress of the chip's searches in the past, which take long in long runs. */

import { begin, type Job } from "./jobs";

let looking: ((share: number) => void) | null = null;

/** The chip tells how far its search is, 0 to 1. */
export function searchIsAt(share: number): void {
  looking?.(share);
}

/** Hear how far the next searches are; return what ends that. */
export function followSearch(tell: (share: number) => void): () => void {
  looking = tell;
  return () => {
    if (looking === tell) looking = null;
  };
}

/** Show searches that take long while they do; `cancel` stops them. Return what ends that. */
export function showSearch(text: string, cancel: () => void): () => void {
  let job: Job | null = null;
  const end = followSearch((share) => {
    job ??= begin(text, cancel);
    job.tell(share);
  });
  return () => {
    end();
    job?.end();
  };
}
