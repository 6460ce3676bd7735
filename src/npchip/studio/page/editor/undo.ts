/** The last change of the program's files, which can be taken back; texts have an undo of their own. */

import { signal } from "@preact/signals";

export interface FileChange {
  /** The change, such as `Deleted part.s.` */
  text: string;
  undo(): void;
}

export const fileChange = signal<FileChange | null>(null);

/** Note what was done to the files, and how it is taken back. */
export function fileChanged(text: string, undo: () => void): void {
  fileChange.value = { text, undo };
}

/** Forget the last change: it cannot be undone in another program. */
export function forgetFileChange(): void {
  fileChange.value = null;
}
