/** The status line, and the text of an error. */

import { signal } from "@preact/signals";
import { message, progress } from "../store";

/**
 * The newest problem, until the reader puts it away or does something new: what is said meanwhile
 * does not hide it.
 */
export const problem = signal("");
message.subscribe(({ kind, text }) => {
  if (kind === "error") problem.value = text;
});

/** The reader has seen the problem. */
export function putAway(): void {
  problem.value = "";
  if (message.peek().kind === "error") say("");
}

export function say(text: string): void {
  message.value = { kind: "info", text };
}

export function sayError(fault: unknown): void {
  message.value = { kind: "error", text: textOf(fault) };
}

export function textOf(fault: unknown): string {
  return fault instanceof Error ? fault.message : String(fault);
}

/** Show that something takes long while `work` runs, and an error if it fails. */
export async function during<T>(text: string, work: () => Promise<T>): Promise<T | null> {
  progress.value = { text, share: null };
  try {
    return await work();
  } catch (fault) {
    if (!(fault instanceof DOMException && fault.name === "AbortError")) sayError(fault);
    return null;
  } finally {
    progress.value = null;
  }
}
