/** Paints the array's shades, 8 × 8 canvas pixels an NP. */

import { inkOn } from "./format";
import { SIDE } from "./planes";

/** A picture of 64 pixels an NP, or a shade for each NP, to be painted. */
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
  const bytes = new Uint8ClampedArray(rows * cols * SIDE * SIDE * 4);
  // A word a pixel: byte by byte, a large array would take longer than a frame of the screen.
  const pixels = new Uint32Array(bytes.buffer);
  for (let np = 0; np < rows * cols; np++) {
    const first = Math.floor(np / cols) * SIDE * width + (np % cols) * SIDE;
    const shade = shades[np] ?? 0;
    for (let y = 0; y < SIDE; y++) {
      const row = first + y * width;
      for (let x = 0; x < SIDE; x++) pixels[row + x] = GREYS[picture ? (picture[row + x] ?? 0) : shade] ?? 0;
    }
    if (marks?.inactive[np]) hatch(pixels, first, width, picture ? (picture[first] ?? 0) : shade);
    if (marks?.changed[np]) fold(pixels, first, width);
  }
  return bytes;
}

function rgb(red: number, green: number, blue: number): number {
  return new Uint32Array(Uint8Array.of(red, green, blue, 255).buffer)[0] ?? 0;
}

const GREYS = Uint32Array.from({ length: 256 }, (_, level) => rgb(level, level, level));
/** The hatch of inactive NPs: on every shade one of them has a contrast of 3. */
const LIGHT = rgb(225, 225, 225);
const DARK = rgb(25, 25, 25);
const MARK = rgb(255, 176, 32);
const EDGE = rgb(0, 0, 0);

function hatch(pixels: Uint32Array, first: number, width: number, shade: number): void {
  const ink = inkOn(shade) === "white" ? LIGHT : DARK;
  for (let y = 0; y < SIDE; y++) {
    for (let x = (SIDE - y) % 4; x < SIDE; x += 4) pixels[first + y * width + x] = ink;
  }
}

/** The mark of a change: a triangle in the upper right corner, with an edge that any shade shows. */
function fold(pixels: Uint32Array, first: number, width: number): void {
  for (let y = 0; y < 4; y++) {
    for (let x = y + SIDE - 4; x < SIDE; x++) {
      pixels[first + y * width + x] = x === y + SIDE - 4 ? EDGE : MARK;
    }
  }
}
