/** The reader's own programs while an example is looked at: nothing that was written is lost. */

import { computed, signal } from "@preact/signals";
import { type Aside, keepAsides, keptAsides } from "./keep";
import type { Shared } from "./share";

/** What the box `Example` shows: the name of an unchanged example, or nothing. */
export const chosenExample = signal("");

/** So many programs are kept; the oldest makes room. */
const MOST = 10;

const all = signal<Aside[]>(keptAsides());

/** The programs to go back to, the newest first. */
export const asides = computed(() => all.value);

/** Set the reader's program aside; null or an empty one leaves those that are there. */
export function setAside(own: Shared | null): void {
  if (!own?.project.files[own.project.main]?.trim()) return;
  const text = JSON.stringify(own);
  const others = all.peek().filter(({ shared }) => JSON.stringify(shared) !== text);
  all.value = [{ at: Date.now(), shared: own }, ...others].slice(0, MOST);
  keepAsides(all.peek());
}
