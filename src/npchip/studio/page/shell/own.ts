/** The reader's own programs while an example is looked at: nothing that was written is lost. */

import { computed, signal } from "@preact/signals";
import { type Aside, keepAsides, keptAsides, onAsides } from "./keep";
import type { Shared } from "./share";

/** Choice in the box `Example`: the name of an unchanged example, or nothing. */
export const chosenExample = signal("");

/** So many programs are kept; the oldest makes room. */
const MOST = 10;

const all = signal<Aside[]>(keptAsides());

/** The programs to go back to, the newest first. */
export const asides = computed(() => all.value);

/** Set the reader's program aside; null or an empty one leaves those that are there.
 *
 * Of each other `tab` the newest program is enough, as it is written on there. True if there is one
 * more now. */
export function setAside(own: Shared | null, tab?: string): boolean {
  if (!own?.project.files[own.project.main]?.trim()) return false;
  const text = JSON.stringify(own);
  const known = merged(keptAsides(), all.peek());
  const others = known.filter((each) => JSON.stringify(each.shared) !== text && !(tab && each.tab === tab));
  all.value = [{ at: Date.now(), shared: own, ...(tab ? { tab } : {}) }, ...others].slice(0, MOST);
  keepAsides(all.peek());
  return others.length === known.length;
}

/** The programs that other tabs have set aside, and those of this one that could not be kept. */
function merged(kept: Aside[], here: Aside[]): Aside[] {
  const texts = new Set(kept.map(({ shared }) => JSON.stringify(shared)));
  const tabs = new Set(kept.map(({ tab }) => tab));
  const lost = here.filter(({ shared, tab }) => !texts.has(JSON.stringify(shared)) && !(tab && tabs.has(tab)));
  return [...kept, ...lost].sort((one, other) => other.at - one.at);
}

/** Show what other tabs set aside, too. */
export function followTabs(): void {
  onAsides(() => {
    all.value = merged(keptAsides(), all.peek()).slice(0, MOST);
  });
}
