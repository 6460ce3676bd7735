/** Colours to luma, bit for bit as npchip's Python gets it from Pillow. */

import type { Size } from "./errors";

/** A picture as luma, row by row. */
export interface Picture extends Size {
  data: Uint8Array<ArrayBuffer>;
}

/** Return the luma of a colour: ITU-R 601 in 16 bits of fraction, rounded. */
export function luma(red: number, green: number, blue: number): number {
  return (red * 19595 + green * 38470 + blue * 7471 + 0x8000) >> 16;
}

/** Return light that passes over black: a channel times its alpha, rounded. */
export function overBlack(value: number, alpha: number): number {
  const product = value * alpha + 128;
  return (product + (product >> 8)) >> 8;
}

/** Return the luma of pixels of four bytes each; `alpha` is false if the fourth means nothing. */
export function lumaOfPixels(
  pixels: Uint8Array | Uint8ClampedArray,
  alpha: boolean,
): Uint8Array<ArrayBuffer> {
  const count = pixels.length >> 2;
  const out = new Uint8Array(count);
  for (let index = 0, at = 0; index < count; index++, at += 4) {
    let red = pixels[at]!;
    let green = pixels[at + 1]!;
    let blue = pixels[at + 2]!;
    const opacity = pixels[at + 3]!;
    if (alpha && opacity !== 255) {
      red = overBlack(red, opacity);
      green = overBlack(green, opacity);
      blue = overBlack(blue, opacity);
    }
    out[index] = (red * 19595 + green * 38470 + blue * 7471 + 0x8000) >> 16;
  }
  return out;
}
