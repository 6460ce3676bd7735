/** Explains the marks in the picture, and chooses how long the path is. */

import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { INK } from "./paint";
import type { MarkKinds } from "./scene";

/** The part of the path that is drawn. */
export const pathLength = signal<"all" | "short" | "none">("all");

const SHORT = 30;
const LONG = 1_000; // more would hide the picture, and take long to draw

/** Return the first frame of the drawn path; null if none is drawn. */
export function pathStart(frame: number): number | null {
  if (pathLength.value === "none") return null;
  if (pathLength.value === "short") return Math.max(0, frame - SHORT + 1);
  // In steps, so that the path is seldom drawn anew.
  return Math.max(0, (Math.floor(frame / LONG) - 1) * LONG);
}

/** The marks that the program has; nothing if it has none. */
export function Legend({ kinds }: { kinds: MarkKinds }): JSX.Element | null {
  if (!kinds.place) return null;
  return (
    <div class="results-legend">
      <span>
        <PathMark /> past path
      </span>
      {kinds.prediction && (
        <span>
          <PredictionMark /> predicted{" "}
          {kinds.ahead === 1 ? "next" : `${kinds.ahead} frames ahead`}
        </span>
      )}
      {kinds.box && (
        <span>
          <BoxMark /> moving pixels
        </span>
      )}
      <label>
        Path{" "}
        <select
          value={pathLength.value}
          onChange={(event) => {
            pathLength.value = event.currentTarget.value as typeof pathLength.value;
          }}
        >
          <option value="all">whole</option>
          <option value="short">last {SHORT} frames</option>
          <option value="none">none</option>
        </select>
      </label>
    </div>
  );
}

function PathMark(): JSX.Element {
  return (
    <svg viewBox="0 0 30 16" width="30" height="16" aria-hidden="true">
      <path d="M4 8H24" stroke={INK.path} stroke-width="2" />
      <circle cx="4" cy="8" r="2.4" fill={INK.path} />
      <circle cx="24" cy="8" r="4" fill={INK.path} />
    </svg>
  );
}

function PredictionMark(): JSX.Element {
  return (
    <svg viewBox="0 0 30 16" width="30" height="16" aria-hidden="true">
      <path d="M1 8H18" stroke={INK.prediction} stroke-width="2" stroke-dasharray="4 3" />
      <path d="M17 2L29 14M17 14L29 2" stroke={INK.prediction} stroke-width="2.6" />
    </svg>
  );
}

function BoxMark(): JSX.Element {
  return (
    <svg viewBox="0 0 30 16" width="30" height="16" aria-hidden="true">
      <rect x="4" y="2" width="22" height="12" fill="none" stroke={INK.box} stroke-width="2" />
    </svg>
  );
}
