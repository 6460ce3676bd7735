/** The luma of a decoded picture, stretched to 0-255 as npchip's Python does. */

import { checkPixels, FramesError } from "./errors";
import type { Picture } from "./luma";

/** How a decoder that gives colours made them of luma and differences of colour. */
export interface Colours {
  /** Shares of red and blue in the luma. */
  red: number;
  blue: number;
  /** True if squares of four pixels share their differences of colour. */
  shared: boolean;
}

const [BT601, BT709] = [
  { red: 0.299, blue: 0.114 },
  { red: 0.2126, blue: 0.0722 },
];
/** Rows from which on browsers take another matrix where a stream declares none. */
const HIGH = 720;

/** Return how a browser makes colours of a stream. */
export function coloursOf(codec: string, rows: number): Colours {
  const declared = codec === "vp8" || codec.startsWith("vp09"); // see vp9.ts
  const matrix = declared || rows < HIGH ? BT601 : BT709;
  return { ...matrix, shared: !/^vp09\.(01|03)/.test(codec) };
}

/** Return a picture's own luma, from colours if the decoder gives these only. */
export async function lumaOfFrame(
  frame: VideoFrame,
  colours: Colours,
  name: string,
): Promise<Picture> {
  const area = frame.visibleRect;
  const [rows, cols] = [area?.height ?? frame.codedHeight, area?.width ?? frame.codedWidth];
  checkPixels({ rows, cols }, name);
  const { format } = frame;
  if (!format || !/^(I4|NV)/.test(format)) {
    const options: VideoFrameCopyToOptions = { format: "RGBA" };
    try {
      const pixels = new Uint8Array(frame.allocationSize(options));
      await frame.copyTo(pixels, options);
      return { rows, cols, data: lumaFromColours(pixels, rows, cols, colours) };
    } catch {
      const help = "Open it in another browser, or convert it to .npy";
      throw new FramesError("NP211", `${name}: the browser does not hand out its pixels`, help);
    }
  }
  const buffer = new Uint8Array(frame.allocationSize());
  const [plane] = await frame.copyTo(buffer);
  const { offset, stride } = plane!;
  const depth = Number(/P(10|12)$/.exec(format)?.[1] ?? 8);
  const shades = stretch(depth, frame.colorSpace.fullRange === true);
  const data = new Uint8Array(rows * cols);
  const wide = depth > 8 ? 2 : 1;
  for (let row = 0, at = 0; row < rows; row++) {
    let from = offset + row * stride;
    for (let col = 0; col < cols; col++, from += wide) {
      const value = wide === 1 ? buffer[from]! : buffer[from]! | (buffer[from + 1]! << 8);
      data[at++] = shades[value]!;
    }
  }
  return { rows, cols, data };
}

const tables = new Map<string, Uint8Array>();

/** Return the grey of each value: videos use 16-235 of 8 bits unless they say that they use all. */
function stretch(depth: number, full: boolean): Uint8Array {
  const key = `${depth} ${full}`;
  let table = tables.get(key);
  if (!table) {
    const unit = 2 ** (depth - 8);
    const [least, span] = full ? [0, 2 ** depth - 1] : [16 * unit, 219 * unit];
    table = Uint8Array.from({ length: 2 ** depth }, (_, value) =>
      Math.min(255, Math.max(0, Math.round(((value - least) * 255) / span))),
    );
    tables.set(key, table);
  }
  return table;
}

/**
 * Return the luma that colours were made of. Colours are cut off at 0 and 255; there, the
 * differences of colour of the other pixels in its square give the luma back.
 */
export function lumaFromColours(
  pixels: Uint8Array,
  rows: number,
  cols: number,
  { red, blue, shared }: Colours,
): Uint8Array<ArrayBuffer> {
  const green = 1 - red - blue;
  const out = new Uint8Array(rows * cols);
  for (let at = 0, from = 0; at < out.length; at++, from += 4) {
    const sum = red * pixels[from]! + green * pixels[from + 1]! + blue * pixels[from + 2]!;
    out[at] = Math.round(sum);
  }
  if (!shared) return out;
  for (let top = 0; top < rows; top += 2) {
    for (let left = 0; left < cols; left += 2) {
      const square = places(top, left, rows, cols);
      if (!square.some((at) => isCut(pixels, 4 * at))) continue;
      const whole = square.filter((at) => !isCut(pixels, 4 * at));
      // Without one, nothing tells what was cut off; other squares may have quite another colour.
      if (whole.length > 0) mend(pixels, out, square, whole, red, blue);
    }
  }
  return out;
}

/** Return the pixels of a square, as far as it lies in the picture. */
function places(top: number, left: number, rows: number, cols: number): number[] {
  const found: number[] = [];
  for (let row = top; row < Math.min(top + 2, rows); row++) {
    for (let col = left; col < Math.min(left + 2, cols); col++) {
      found.push(row * cols + col);
    }
  }
  return found;
}

function isCut(pixels: Uint8Array, from: number): boolean {
  for (let c = 0; c < 3; c++) if (pixels[from + c] === 0 || pixels[from + c] === 255) return true;
  return false;
}

function mend(
  pixels: Uint8Array,
  out: Uint8Array,
  square: number[],
  whole: number[],
  red: number,
  blue: number,
): void {
  const green = 1 - red - blue;
  let [reds, blues] = [0, 0];
  for (const at of whole) {
    const [r, g, b] = [pixels[4 * at]!, pixels[4 * at + 1]!, pixels[4 * at + 2]!];
    const grey = red * r + green * g + blue * b;
    reds += (r - grey) / whole.length;
    blues += (b - grey) / whole.length;
  }
  const shifts = [reds, -(red * reds + blue * blues) / green, blues];
  for (const at of square) {
    let [sum, count] = [0, 0];
    for (const [c, shift] of shifts.entries()) {
      const value = pixels[4 * at + c]!;
      if (value === 0 || value === 255) continue;
      sum += value - shift;
      count++;
    }
    if (count > 0 && count < 3) out[at] = Math.min(255, Math.max(0, Math.round(sum / count)));
  }
}
