/** The status line, and the text of an error. */

import { message, progress } from "../store";

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
