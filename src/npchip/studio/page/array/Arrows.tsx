/** Arrows across the array, from each neighbour to the NP that takes its value. */

import type { JSX } from "preact";
import type { ChipView, Move } from "../protocol";
import { UNIT, arrowsOf, spacing, type Arrow } from "./moves";
import { format } from "./format";
import { base, type Passing } from "./state";

interface Props {
  passing: Passing;
  view: ChipView;
  rows: number;
  cols: number;
}

/** Arrows that stay, and values that run along them once. The legend says the same in words. */
export function Arrows({ passing, view, rows, cols }: Props): JSX.Element {
  const active = passing.from?.active ?? view.active;
  const scale = spacing(rows, cols);
  return (
    <svg class="array-arrows" viewBox={`0 0 ${cols * UNIT} ${rows * UNIT}`} aria-hidden="true">
      {passing.moves.map((move, index) => {
        const all = arrowsOf(move, active, passing.from, rows, cols);
        const way = { "--dx": `${-move.column * UNIT * scale}px`, "--dy": `${-move.row * UNIT * scale}px` };
        return (
          <g key={`${passing.moment}/${index}`} style={way}>
            {all.map((arrow) => (
              <Shaft key={`${arrow.row},${arrow.column}`} arrow={arrow} move={move} scale={scale} />
            ))}
            {all.map((arrow) => (
              <Value key={`${arrow.row},${arrow.column}`} arrow={arrow} move={move} scale={scale} />
            ))}
          </g>
        );
      })}
    </svg>
  );
}

interface Part {
  arrow: Arrow;
  move: Move;
  scale: number;
}

/** An arrow over the border between two NPs, short enough to leave the numbers free. */
function Shaft({ arrow, move, scale }: Part): JSX.Element {
  const x = (arrow.column + 0.5 * (1 + move.column)) * UNIT;
  const y = (arrow.row + 0.5 * (1 + move.row)) * UNIT;
  const turn = Math.atan2(-move.row, -move.column) * (180 / Math.PI);
  const shape = "M-2.6-.55H.2V-1.9L2.9 0 .2 1.9V.55H-2.6Z";
  return <path d={shape} transform={`translate(${x} ${y}) rotate(${turn}) scale(${scale})`} />;
}

function Value({ arrow, move, scale }: Part): JSX.Element | null {
  if (arrow.value === null) return null;
  const x = (arrow.column + 0.5 + move.column * scale) * UNIT;
  const y = (arrow.row + 0.5 + move.row * scale) * UNIT;
  return (
    <text x={x} y={y} font-size={3.2 * scale}>
      {format(arrow.value, base.value)}
    </text>
  );
}
