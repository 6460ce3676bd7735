/** The last change of the program's files, which can be taken back; texts have an undo of their own. */

import { signal } from "@preact/signals";

export interface FileChange {
  /** What was done, such as `Deleted part.s.` */
  text: string;
  undo(): void;
}

export const fileChange = signal<FileChange | null>(null);

/** Note what was done to the files, and how it is taken back. */
export function fileChanged(text: string, undo: () => void): void {
  fileChange.value = { text, undo };
}

/** What was done before cannot be taken back any more, as another program is there. */
export function forgetFileChange(): void {
  fileChange.value = null;
}
