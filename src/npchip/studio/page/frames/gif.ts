/** GIF, read here: what is disposed of becomes black, and damage is told. */

import { Bytes } from "./bytes";
import { checkPixels, damaged } from "./errors";
import type { Picture } from "./luma";
import type { Pictures } from "./pictures";
import { paletteLuma } from "./raster";

const CONTROL = 0xf9;
const [TO_BACKGROUND, TO_PREVIOUS] = [2, 3];

/** A part of the screen that the file stores. */
interface Part {
  left: number;
  top: number;
  cols: number;
  rows: number;
  interlaced: boolean;
  palette: Uint8Array;
  /** Colour that is transparent; -1 if there is none. */
  hole: number;
  disposal: number;
  milliseconds: number;
  /** Place of its packed pixels in the file. */
  start: number;
}

class Damage extends Error {}

/** Read the pictures of a GIF, each composed of what the file stores; transparent is black. */
export function gifPictures(data: Uint8Array<ArrayBuffer>, name: string): Pictures {
  const bytes = new Bytes(data);
  const parts: Part[] = [];
  let [rows, cols] = [0, 0];
  let reason: string | null = null;
  try {
    const start = take(bytes, 13);
    const common = colours(bytes, start[10]!);
    [cols, rows] = [bytes.view.getUint16(6, true), bytes.view.getUint16(8, true)];
    for (let part = next(bytes, common); part; part = next(bytes, common)) parts.push(part);
  } catch (error) {
    if (!(error instanceof Damage)) throw error;
    reason = error.message;
  }
  const first = parts[0];
  if (first) {
    // As viewers do where the screen is smaller than the first part.
    rows = Math.max(rows, first.top + first.rows);
    cols = Math.max(cols, first.left + first.cols);
    checkPixels({ rows, cols }, name);
  }
  const count = parts.length + (reason === null ? 0 : 1);
  return {
    count,
    each: compose(data, { rows, cols }, parts, name, reason),
    duration: parts.length > 1 ? first!.milliseconds : undefined,
  };
}

async function* compose(
  data: Uint8Array<ArrayBuffer>,
  { rows, cols }: { rows: number; cols: number },
  parts: Part[],
  name: string,
  reason: string | null,
): AsyncGenerator<Picture> {
  let screen = new Uint8Array(rows * cols);
  for (const [index, part] of parts.entries()) {
    const before = part.disposal === TO_PREVIOUS ? screen.slice() : screen;
    const pixels = unpackLzw(data, part, `${name}, frame ${index}`);
    draw(screen, rows, cols, part, pixels);
    yield { rows, cols, data: screen.slice() };
    if (part.disposal === TO_BACKGROUND) draw(screen, rows, cols, part, null);
    screen = before;
  }
  if (reason !== null) throw damaged(`${name}, frame ${parts.length}`, reason);
}

/** Draw a part, or black in its place without pixels. */
function draw(
  screen: Uint8Array,
  rows: number,
  cols: number,
  part: Part,
  pixels: Uint8Array | null,
): void {
  const shades = paletteLuma(part.palette);
  const width = Math.min(part.cols, cols - part.left);
  for (let row = 0; row < part.rows && part.top + row < rows; row++) {
    const to = (part.top + row) * cols + part.left;
    for (let col = 0; col < width; col++) {
      const pixel = pixels ? pixels[row * part.cols + col]! : -2;
      if (pixel === -2) screen[to + col] = 0;
      else if (pixel !== part.hole) screen[to + col] = shades[pixel]!;
    }
  }
}

/** Read the next part with what applies to it; null at the end. */
function next(bytes: Bytes, common: Uint8Array | null): Part | null {
  let [hole, disposal, milliseconds] = [-1, 0, 0];
  for (;;) {
    const kind = take(bytes, 1)[0]!;
    if (kind === 0x3b) return null;
    if (kind === 0x21) {
      const label = take(bytes, 1)[0];
      const data = blocks(bytes);
      if (label !== CONTROL || data.length < 4) continue;
      hole = data[0]! & 1 ? data[3]! : -1;
      disposal = (data[0]! >> 2) & 7;
      milliseconds = 10 * (data[1]! | (data[2]! << 8));
    } else if (kind === 0x2c) {
      const at = bytes.at;
      const flags = take(bytes, 9)[8]!;
      const [left, top, cols, rows] = [0, 2, 4, 6].map((k) => bytes.view.getUint16(at + k, true));
      const palette = colours(bytes, flags) ?? common;
      const start = bytes.at;
      take(bytes, 1);
      blocks(bytes);
      const missing = !palette ? "colours" : !rows || !cols ? "pixels" : null;
      if (missing) throw new Damage(`a part of the GIF has no ${missing}`);
      return {
        ...{ left: left!, top: top!, cols: cols!, rows: rows! },
        ...{ interlaced: (flags & 0x40) !== 0, palette: palette! },
        ...{ hole, disposal, milliseconds, start },
      };
    } else throw new Damage(`no part of a GIF begins with byte ${kind}`);
  }
}

function take(bytes: Bytes, count: number): Uint8Array {
  const taken = bytes.take(count);
  if (!taken) throw new Damage("the GIF does not end where it should; it may be cut short");
  return taken;
}

function colours(bytes: Bytes, flags: number): Uint8Array | null {
  return flags & 0x80 ? take(bytes, 3 << ((flags & 7) + 1)) : null;
}

/** Pass over data in blocks; return the first. */
function blocks(bytes: Bytes): Uint8Array {
  const first = take(bytes, take(bytes, 1)[0]!);
  let length = first.length;
  while (length > 0) {
    length = take(bytes, 1)[0]!;
    take(bytes, length);
  }
  return first;
}

/** Return the colour numbers of a part. */
function unpackLzw(file: Uint8Array, part: Part, name: string): Uint8Array {
  const least = file[part.start]!;
  if (least > 12) throw damaged(name, "its packed pixels cannot be unpacked");
  const [clear, end] = [1 << least, (1 << least) + 1];
  const prefix = new Uint16Array(4096);
  const suffix = new Uint8Array(4096);
  const stack = new Uint8Array(4097);
  for (let code = 0; code < clear; code++) suffix[code] = code;
  const out = new Uint8Array(part.rows * part.cols);
  const put = lineUp(out, part);
  let [width, used, last, initial] = [least + 1, end + 1, -1, 0];
  let [bits, held, at] = [0, 0, part.start + 1];
  let [block, filled] = [file[at]!, 0];
  while (filled < out.length) {
    while (held < width) {
      if (block === 0) throw damaged(name, "its packed pixels are cut short");
      bits |= file[++at]! << held;
      held += 8;
      if (--block === 0) block = file[++at]!;
    }
    const code = bits & ((1 << width) - 1);
    bits >>>= width;
    held -= width;
    if (code === clear) {
      [width, used, last] = [least + 1, end + 1, -1];
      continue;
    }
    if (code === end) throw damaged(name, "its packed pixels are cut short");
    if (code > used || (code === used && last < 0) || (last < 0 && code > clear)) {
      throw damaged(name, "its packed pixels cannot be unpacked");
    }
    let depth = 0;
    let rest = code;
    if (code === used) {
      stack[depth++] = initial;
      rest = last;
    }
    while (rest > end) {
      stack[depth++] = suffix[rest]!;
      rest = prefix[rest]!;
    }
    initial = suffix[rest]!;
    stack[depth++] = initial;
    while (depth > 0 && filled < out.length) put(filled++, stack[--depth]!);
    if (last >= 0 && used < 4096) {
      prefix[used] = last;
      suffix[used] = initial;
      used++;
      if (used === 1 << width && width < 12) width++;
    }
    last = code;
  }
  return out;
}

/** Return what puts the n-th pixel of the data in its place, in any order of rows. */
function lineUp(out: Uint8Array, part: Part): (index: number, pixel: number) => void {
  if (!part.interlaced) {
    return (index, pixel) => {
      out[index] = pixel;
    };
  }
  const order: number[] = [];
  for (const [start, step] of [[0, 8], [4, 8], [2, 4], [1, 2]] as const) {
    for (let row = start; row < part.rows; row += step) order.push(row);
  }
  return (index, pixel) => {
    const row = Math.floor(index / part.cols);
    out[order[row]! * part.cols + (index % part.cols)] = pixel;
  };
}
