/** Paints the array's shades, 8 × 8 canvas pixels an NP. */

import { inkOn } from "./format";
import { SIDE } from "./planes";

/** What is painted: a picture of 64 pixels an NP, or a shade for each NP. */
export interface Painting {
  rows: number;
  cols: number;
  picture: Uint8Array | null;
  /** One an NP; counts without a picture. */
  shades: ArrayLike<number>;
  /** Marks to paint into the picture; null where the page's own elements show them. */
  marks: { inactive: ArrayLike<unknown>; changed: ArrayLike<unknown> } | null;
}

/** Return the canvas pixels as RGBA. */
export function paint({ rows, cols, picture, shades, marks }: Painting): Uint8ClampedArray<ArrayBuffer> {
  const width = cols * SIDE;
  const pixels = new Uint8ClampedArray(rows * cols * SIDE * SIDE * 4).fill(255);
  for (let at = 0; at * 4 < pixels.length; at++) {
    const y = Math.floor(at / width);
    const x = at % width;
    const np = Math.floor(y / SIDE) * cols + Math.floor(x / SIDE);
    const grey = (picture ? picture[at] : shades[np]) ?? 0;
    let colour: readonly [number, number, number] = [grey, grey, grey];
    if (marks?.inactive[np] && (x + y) % 4 === 0) colour = inkOn(grey) === "white" ? LIGHT : DARK;
    if (marks?.changed[np]) colour = corner(y % SIDE, x % SIDE) ?? colour;
    pixels.set(colour, at * 4);
  }
  return pixels;
}

/** The hatch of inactive NPs: on every shade one of them has a contrast of 3. */
const LIGHT = [225, 225, 225] as const;
const DARK = [25, 25, 25] as const;
const MARK = [255, 176, 32] as const;
const EDGE = [0, 0, 0] as const;

/** The mark of a change: a triangle in the upper right corner, with an edge that any shade shows. */
function corner(y: number, x: number): readonly [number, number, number] | null {
  const inside = x - y;
  if (inside >= SIDE - 3) return MARK;
  return inside === SIDE - 4 ? EDGE : null;
}
