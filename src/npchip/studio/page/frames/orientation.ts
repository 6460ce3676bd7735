/** The orientation that a camera notes in EXIF, and turning by it. */

import { standsAt } from "./bytes";
import type { Picture } from "./luma";

const ORIENTATION = 0x0112;
const STARTS = ["II*\0", "MM\0*", "II\0*", "MM*\0", "II+\0", "MM\0+"];
/** Readers of a whole number, by type; other types state no orientation. */
const TYPES: Record<number, (view: DataView, at: number, little: boolean) => number> = {
  3: (view, at, little) => view.getUint16(at, little),
  4: (view, at, little) => view.getUint32(at, little),
  6: (view, at) => view.getInt8(at),
  8: (view, at, little) => view.getInt16(at, little),
  9: (view, at, little) => view.getInt32(at, little),
};

/**
 * Return the orientation, 1 to 8, that EXIF data states; 1 if it states none.
 *
 * Raises a RangeError if the data does not begin as EXIF, which npchip takes for damage too.
 */
export function orientationOf(exif: Uint8Array): number {
  const start = standsAt(exif, 0, "Exif\0\0") ? 6 : 0;
  const data = exif.subarray(start);
  if (data.length === 0) return 1;
  if (!STARTS.some((text) => standsAt(data, 0, text))) throw new RangeError("no EXIF begins so");
  const view = new DataView(data.buffer, data.byteOffset, data.length);
  try {
    const little = data[0] === 0x49;
    const directory = view.getUint32(4, little);
    const count = view.getUint16(directory, little);
    for (let index = 0; index < count; index++) {
      const at = directory + 2 + 12 * index;
      if (view.getUint16(at, little) !== ORIENTATION) continue;
      const read = TYPES[view.getUint16(at + 2, little)];
      if (!read || view.getUint32(at + 4, little) !== 1) return 1;
      const value = read(view, at + 8, little);
      return value >= 1 && value <= 8 ? value : 1;
    }
  } catch {
    // The list of notes ends early: what it states until there counts.
  }
  return 1;
}

/** Turn and mirror a picture so that it stands upright. */
export function upright(picture: Picture, orientation: number): Picture {
  if (orientation === 1) return picture;
  const turned = orientation >= 5;
  const mirrored = [2, 3, 7, 8].includes(orientation);
  const flipped = [3, 4, 6, 7].includes(orientation);
  return turn(picture, turned, flipped, mirrored);
}

/**
 * Exchange rows and columns if asked for, after reading rows from below (`flipped`) and columns
 * from the right (`mirrored`).
 */
export function turn(
  picture: Picture,
  exchange: boolean,
  flipped: boolean,
  mirrored: boolean,
): Picture {
  const { rows, cols, data } = picture;
  const out = new Uint8Array(data.length);
  let at = 0;
  const outer = exchange ? cols : rows;
  const inner = exchange ? rows : cols;
  for (let one = 0; one < outer; one++) {
    for (let two = 0; two < inner; two++) {
      const row = exchange ? two : one;
      const col = exchange ? one : two;
      const from = (flipped ? rows - 1 - row : row) * cols + (mirrored ? cols - 1 - col : col);
      out[at++] = data[from]!;
    }
  }
  return { rows: outer, cols: inner, data: out };
}

/** Return the orientation that an XMP packet states; 1 if none. */
export function orientationOfXmp(packet: Uint8Array): number {
  const found = /tiff:Orientation(?:="|>)([0-9])/.exec(new TextDecoder("latin1").decode(packet));
  const value = Number(found?.[1] ?? 1);
  return value >= 1 && value <= 8 ? value : 1;
}
