/** The status line, the text of an error, and work whose errors it says. */

import { message } from "./store";

export function say(text: string): void {
  message.value = { kind: "info", text };
}

/** Say what went wrong; what was stopped on purpose is no error. */
export function sayError(fault: unknown): void {
  if (fault instanceof DOMException && fault.name === "AbortError") return;
  message.value = { kind: "error", text: textOf(fault) };
}

export function textOf(fault: unknown): string {
  return fault instanceof Error ? fault.message : String(fault);
}

/** Let work go on by itself, for callers that do not wait: an error is said, and never lost. */
export function heard(work: Promise<unknown>): void {
  work.catch(sayError);
}
