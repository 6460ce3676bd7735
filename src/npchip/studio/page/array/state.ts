/** State of these panels: the moments before the present one, and how things are shown. */

import { computed, effect, signal } from "@preact/signals";
import type { ChipView, Move } from "../protocol";
import { pace, program, running, shownCell, view } from "../store";
import type { Base } from "./format";
import type { Shown } from "./planes";

/** The chip may be seen twice at a moment, which is no step. */
function isSameMoment(one: ChipView | null, other: ChipView | null): boolean {
  return one?.instructions === other?.instructions && one?.cycles === other?.cycles && one?.frame === other?.frame;
}

/** The chip as it stood at the last stop, and at the one before. */
const settled = signal<ChipView | null>(null);
const earlier = signal<ChipView | null>(null);

/** The chip at the stop with which the present moment is compared; null if there was none. */
export const reference = computed<ChipView | null>(() =>
  view.value === settled.value ? earlier.value : settled.value,
);

/** Milliseconds between two looks at a running chip where there are many numbers: they can be read. */
const CALM = 150;
let lookedAt = 0;

/** The chip for panels with many numbers: up to date while it stands, now and then while it runs. */
export const calm = signal<ChipView | null>(null);

effect(() => {
  const seen = view.value;
  const now = performance.now();
  if (running.value && now - lookedAt < CALM) return;
  lookedAt = now;
  calm.value = seen;
});

/** The last two views, to tell a single step. */
const latest = signal<ChipView | null>(null);
const previous = signal<ChipView | null>(null);

effect(() => {
  const seen = view.value;
  const last = latest.peek();
  if (seen === last) return;
  if (!isSameMoment(seen, last)) previous.value = last;
  latest.value = seen;
});

effect(() => {
  const seen = view.value;
  const last = settled.peek();
  if (running.value || seen === last) return;
  if (!isSameMoment(seen, last)) earlier.value = last;
  settled.value = seen;
});

// Values of another program are nothing to compare with.
effect(() => {
  program.value;
  settled.value = view.peek();
  earlier.value = null;
  previous.value = null;
});

/** The view just before the instruction executed last; null unless it was seen. */
const justBefore = computed<ChipView | null>(() => {
  const now = latest.value;
  const old = previous.value;
  return now && old && now.instructions === old.instructions + 1 ? old : null;
});

/** Address of the instruction executed last; null if it is not known. */
export const executed = computed<number | null>(() => {
  const last = latest.value?.last;
  return last === undefined ? (justBefore.value?.address ?? null) : last;
});

/** Values on their way from neighbours. */
export interface Passing {
  moves: Move[];
  /** The chip before they moved; null if it is not known. */
  from: ChipView | null;
  /** Tells one execution from the next. */
  moment: number;
}

/** Steps a second up to which the eye can follow what moves. */
const FOLLOWED = 5;

/** Values that the last instruction took from neighbours; null if none, or too fast to see. */
export const passing = computed<Passing | null>(() => {
  const speed = pace.value;
  const slow = speed !== "max" && speed.unit === "steps" && speed.rate <= FOLLOWED;
  if (running.value && !slow) return null;
  const word = executed.value === null ? null : program.value?.words[executed.value];
  if (!word?.moves?.length) return null;
  return { moves: word.moves, from: justBefore.value, moment: latest.value?.instructions ?? 0 };
});

/** The base in which numbers are written. */
export const base = signal<Base>("decimal");

/** A picture instead of the cell that the store names. */
export const picture = signal<Exclude<Shown, { kind: "cell" }> | null>(null);

/** The contents of the array that are shown. */
export const shown = computed<Shown>(() => picture.value ?? { kind: "cell", cell: shownCell.value });

/** Rows and columns of NPs; those of the default machine before there is a program. */
export const geometry = computed(() => ({
  rows: program.value?.machine.np_rows ?? 8,
  cols: program.value?.machine.np_cols ?? 10,
}));
