/** The reader's own program while an example is looked at: nothing that was written is lost. */

import { computed, signal } from "@preact/signals";
import { keepAside, keptAside } from "./keep";
import type { Shared } from "./share";

/** What the box `Example` shows: the name of an unchanged example, or nothing. */
export const chosenExample = signal("");

const aside = signal<Shared | null>(keptAside());

/** True if there is a program to go back to. */
export const hasAside = computed(() => aside.value !== null);

export function asideOf(): Shared | null {
  return aside.peek();
}

/** Set the reader's program aside; null or an empty one leaves the one that was there. */
export function setAside(own: Shared | null): void {
  if (!own?.project.files[own.project.main]?.trim()) return;
  aside.value = own;
  keepAside(own);
}
