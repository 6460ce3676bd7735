/** The luma of a decoded picture, stretched to 0-255 as npchip's Python does. */

import { pixelsOf } from "./browser";
import { checkPixels } from "./errors";
import { luma, lumaOfPixels, type Picture } from "./luma";

/** The rule by which a decoder that gives colours made them of luma and chroma. */
export interface Colours {
  /** Shares of red and blue in the luma. */
  red: number;
  blue: number;
  /** True if values take all of the range, null if the decoder must tell. */
  full: boolean | null;
  /** True if npchip takes the luma of the colours, false if it takes the stream's own. */
  remade: boolean;
  /** True if squares of four pixels share their differences of colour. */
  shared: boolean;
}

type Shares = Pick<Colours, "red" | "blue">;
const [ITU601, ITU709, ITU2020]: [Shares, Shares, Shares] = [
  { red: 0.299, blue: 0.114 },
  { red: 0.2126, blue: 0.0722 },
  { red: 0.2627, blue: 0.0593 },
];
/** By their names in WebCodecs. */
const MATRICES: Record<string, Shares> = {
  bt709: ITU709,
  bt470bg: ITU601,
  smpte170m: ITU601,
  "bt2020-ncl": ITU2020,
};
/** Rows from which on browsers take another matrix where a stream declares none. */
const LARGE = 720;

/** Return how the colours of a stream are made that declares a matrix, or none. */
export function coloursOf(codec: string, rows: number, declared: VideoColorSpaceInit): Colours {
  const known = MATRICES[declared.matrix ?? ""];
  // Where none is declared, Firefox makes the colours of VP9 by ITU-R 709 in every size.
  const small = codec === "vp8" || (rows < LARGE && !codec.startsWith("vp09"));
  const shares = known ?? (small ? ITU601 : ITU709);
  const remade = known !== undefined && known !== ITU601;
  const full = declared.fullRange ?? null;
  return { ...shares, full, remade, shared: !/^vp09\.(01|03)/.test(codec) };
}

/** Return a picture's own luma, or that of its colours, as npchip takes it. */
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
    const { data: pixels } = await pixelsOf(frame, name);
    if (colours.full) {
      return { rows, cols, data: fullRangeLuma(pixels, colours) };
    }
    const data = colours.remade
      ? lumaOfPixels(pixels, false)
      : lumaFromColours(pixels, rows, cols, colours);
    return { rows, cols, data };
  }
  const buffer = new Uint8Array(frame.allocationSize());
  const layout = await frame.copyTo(buffer);
  const planes: Planes = {
    ...{ rows, cols, buffer, layout },
    depth: Number(/P(10|12)$/.exec(format)?.[1] ?? 8),
    full: colours.full ?? frame.colorSpace.fullRange === true,
    pairs: format.startsWith("NV"),
    down: /^(I420|NV12)/.test(format) ? 1 : 0,
    across: format.startsWith("I444") ? 0 : 1,
  };
  return { rows, cols, data: colours.remade ? remadeLuma(planes, colours) : ownLuma(planes) };
}

/**
 * Return the luma of a stream that takes all of the range. Firefox makes colours as if it were
 * 16-235 all the same: so this is undone. What lay outside is cut off; it becomes black or white.
 */
function fullRangeLuma(pixels: Uint8Array, { red, blue, remade }: Colours): Uint8Array<ArrayBuffer> {
  const data = new Uint8Array(pixels.length >> 2);
  for (let at = 0, from = 0; at < data.length; at++, from += 4) {
    const [r, g, b] = [pixels[from]!, pixels[from + 1]!, pixels[from + 2]!];
    const sum = red * r + (1 - red - blue) * g + blue * b;
    if (r + g + b === 0 || r + g + b === 3 * 255) {
      data[at] = r;
      continue;
    }
    const grey = 16 + (sum * 219) / 255;
    const tint = 224 / 255;
    const [one, two, three] = [r, g, b].map((value) => cut(grey + (value - sum) * tint));
    data[at] = remade ? luma(one!, two!, three!) : Math.round(grey);
  }
  return data;
}

/** A picture as it is stored: luma, and differences of colour of half its size or all of it. */
interface Planes {
  rows: number;
  cols: number;
  buffer: Uint8Array;
  layout: PlaneLayout[];
  depth: number;
  /** True if values take all of the range. */
  full: boolean;
  /** True if both differences stand side by side. */
  pairs: boolean;
  /** Rows and columns are halved so many times for differences of colour. */
  down: number;
  across: number;
}

function ownLuma({ rows, cols, buffer, layout, depth, full }: Planes): Uint8Array<ArrayBuffer> {
  const { offset, stride } = layout[0]!;
  const shades = stretch(depth, full);
  const data = new Uint8Array(rows * cols);
  const wide = depth > 8 ? 2 : 1;
  for (let row = 0, at = 0; row < rows; row++) {
    let from = offset + row * stride;
    for (let col = 0; col < cols; col++, from += wide) {
      const value = wide === 1 ? buffer[from]! : buffer[from]! | (buffer[from + 1]! << 8);
      data[at++] = shades[value]!;
    }
  }
  return data;
}

/** Make colours by the declared matrix, and ITU-R 601's luma of these. */
function remadeLuma(planes: Planes, { red, blue }: Shares): Uint8Array<ArrayBuffer> {
  const { rows, cols, buffer, layout, depth, full, pairs, down, across } = planes;
  const wide = depth > 8 ? 2 : 1;
  const unit = 2 ** (depth - 8);
  const [black, grain, tint] = full
    ? [0, 255 / (2 ** depth - 1), 255 / (2 ** depth - 1)]
    : [16 * unit, 255 / (219 * unit), 255 / (224 * unit)];
  const sample = (plane: number, row: number, index: number): number => {
    const { offset, stride } = layout[plane]!;
    const from = offset + row * stride + index * wide;
    return wide === 1 ? buffer[from]! : buffer[from]! | (buffer[from + 1]! << 8);
  };
  const data = new Uint8Array(rows * cols);
  for (let row = 0, at = 0; row < rows; row++) {
    for (let col = 0; col < cols; col++) {
      const [y, x] = [row >> down, col >> across];
      const blueness = pairs ? sample(1, y, 2 * x) : sample(1, y, x);
      const redness = pairs ? sample(1, y, 2 * x + 1) : sample(2, y, x);
      const grey = (sample(0, row, col) - black) * grain;
      const r = grey + 2 * (1 - red) * tint * (redness - 128 * unit);
      const b = grey + 2 * (1 - blue) * tint * (blueness - 128 * unit);
      const g = (grey - red * r - blue * b) / (1 - red - blue);
      data[at++] = (cut(r) * 19595 + cut(g) * 38470 + cut(b) * 7471) >> 16;
    }
  }
  return data;
}

/** Bring a channel to 0-255 without its fraction, as PyAV does. */
function cut(value: number): number {
  return Math.min(255, Math.max(0, Math.floor(value)));
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
function lumaFromColours(
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
