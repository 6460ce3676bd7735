/** Arrows that show a move, and the values on them. */

import type { ChipView, Move } from "../protocol";

/** Units of the drawing for the side of an NP. */
export const UNIT = 10;

/** A value that an NP took; `value` is null if it is not known. */
export interface Arrow {
  row: number;
  column: number;
  value: number | null;
}

/** Return the arrows of a move: one for each NP that read, or for every few of a large array. */
export function arrowsOf(
  move: Move,
  active: Uint8Array,
  from: ChipView | null,
  rows: number,
  cols: number,
): Arrow[] {
  const every = spacing(rows, cols);
  const found: Arrow[] = [];
  for (let row = 0; row < rows; row += every) {
    for (let column = 0; column < cols; column += every) {
      if (!active[row * cols + column]) continue;
      found.push({ row, column, value: valueAt(move, row, column, from, rows, cols) });
    }
  }
  return found;
}

/** Return how many NPs apart the arrows stand. */
export function spacing(rows: number, cols: number): number {
  return Math.max(1, Math.ceil(Math.max(rows, cols) / 20));
}

/** Outside the array lies 0. */
function valueAt(
  move: Move,
  row: number,
  column: number,
  from: ChipView | null,
  rows: number,
  cols: number,
): number | null {
  const r = row + move.row;
  const c = column + move.column;
  if (move.register === null || !from) return null;
  if (r < 0 || r >= rows || c < 0 || c >= cols) return 0;
  return from.registers[(move.register * rows + r) * cols + c] ?? null;
}
