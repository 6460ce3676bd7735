/** The status line, the text of an error, and work whose errors it says. */

import { signal } from "@preact/signals";
import { message } from "./store";

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
