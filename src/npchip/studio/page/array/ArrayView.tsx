/** The array: a value or a picture of every NP, what changed, and what moves. */

import type { JSX } from "preact";
import { chosen, program, view } from "../store";
import { format } from "./format";
import { Chooser } from "./Chooser";
import { Field } from "./Field";
import { shownText } from "./names";
import { planeOf } from "./planes";
import { base, geometry, passing, shown } from "./state";

/** The array of NPs, with a chooser of what it shows. */
export function ArrayView(): JSX.Element {
  const { rows, cols } = geometry.value;
  const now = view.value;
  return (
    <section class="array-view" aria-label="Array" data-letters>
      <div class="array-layout">
        <Chooser />
        {now?.active.length === rows * cols ? (
          <Field view={now} rows={rows} cols={cols} />
        ) : (
          <p class="array-empty">Run or step a program to see what its {rows * cols} NPs hold.</p>
        )}
        <Legend />
      </div>
    </section>
  );
}

function Legend(): JSX.Element {
  const moving = passing.value?.moves.map(({ row, column, register }) => {
    const value = register === null ? "a value" : `r${register}`;
    return `each active NP took ${value} of the NP to its ${side(row, column)}`;
  });
  return (
    <div class="array-legend">
      {moving && <p class="array-moving">Arrows: {moving.join(", then ")}.</p>}
      <ul>
        <li>
          <span class="array-swatch array-inactive" aria-hidden="true" />
          inactive
        </li>
        <li>
          <span class="array-swatch array-changed" aria-hidden="true" />
          changed since the last stop
        </li>
        <li>
          <span class="array-swatch array-chosen" aria-hidden="true" />
          chosen
        </li>
      </ul>
      <p class="array-shown">{chosenText()}</p>
    </div>
  );
}

/** Name what the array shows, with its value in the chosen NP: a large array has no room for it. */
function chosenText(): string {
  const what = shown.value;
  const { row, column } = chosen.value;
  const name = shownText(program.value, what);
  if (what.kind !== "cell" || !view.value) return name;
  const value = planeOf(view.value, what.cell)[row * geometry.value.cols + column];
  return value === undefined ? name : `${name} of NP ${row}, ${column}: ${format(value, base.value)}`;
}

function side(row: number, column: number): string {
  if (row) return row < 0 ? "north" : "south";
  return column < 0 ? "west" : "east";
}
