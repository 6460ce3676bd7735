/** A clip as a `.npy` file, which npchip and NumPy read. */

import type { Clip } from "../protocol";

/** Encode a clip as `.npy`, format 1.0: uint8 of shape (T, rows, columns). */
export function encodeNpy(clip: Clip): Uint8Array<ArrayBuffer> {
  const shape = `(${clip.count}, ${clip.rows}, ${clip.cols})`;
  const text = `{'descr': '|u1', 'fortran_order': False, 'shape': ${shape}, }`;
  const start = 10;
  const length = Math.ceil((start + text.length + 1) / 64) * 64 - start;
  const out = new Uint8Array(start + length + clip.data.length);
  out.set([0x93, ...new TextEncoder().encode("NUMPY"), 1, 0, length & 255, length >> 8]);
  out.set(new TextEncoder().encode(`${text.padEnd(length - 1)}\n`), start);
  out.set(clip.data, start + length);
  return out;
}

/** Return the name to save a clip under. */
export function npyName(clip: Clip): string {
  const stem = clip.name.replace(/\.[^.]*$/, "").replace(/[^\w.-]+/g, "_");
  return `${stem || "clip"}.npy`;
}
