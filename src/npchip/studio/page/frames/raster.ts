/** The pixels of a PNG: unpacked, with their filters undone, as samples of 8 bits. */

import { unpack } from "./bytes";
import { damaged, type Size } from "./errors";
import { luma, overBlack } from "./luma";

/** Samples of a picture, pixel after pixel. */
export type Raster = Uint8Array<ArrayBuffer>;

/** The layout of a PNG's pixels. */
export interface Layout extends Size {
  kind: "grey" | "colour" | "palette" | "grey-alpha" | "colour-alpha";
  channels: number;
  depth: number;
  interlaced: boolean;
  palette: Uint8Array | null;
  /** The chunk that says what is transparent. */
  holes: Uint8Array | null;
}

const KINDS: Record<number, [Layout["kind"], number, number[]]> = {
  0: ["grey", 1, [1, 2, 4, 8, 16]],
  2: ["colour", 3, [8, 16]],
  3: ["palette", 1, [1, 2, 4, 8]],
  4: ["grey-alpha", 2, [8, 16]],
  6: ["colour-alpha", 4, [8, 16]],
};

/** Row and column of the first pixel, and steps, of the seven pictures of an interlaced one. */
const PASSES: [number, number, number, number][] = [
  [0, 0, 8, 8],
  [0, 4, 8, 8],
  [4, 0, 8, 4],
  [0, 2, 4, 4],
  [2, 0, 4, 2],
  [0, 1, 2, 2],
  [1, 0, 2, 1],
];

/** Read a header; null if no PNG has it. */
export function layoutOf(header: DataView): Layout | null {
  const [cols, rows, depth] = [header.getUint32(0), header.getUint32(4), header.getUint8(8)];
  const [kind, channels, depths] = KINDS[header.getUint8(9)] ?? ["grey", 1, []];
  if (!depths.includes(depth) || header.getUint8(11) !== 0) return null;
  const interlaced = header.getUint8(12) !== 0;
  return { rows, cols, kind, channels, depth, interlaced, palette: null, holes: null };
}

/** Unpack the pixels of a part of this size: greys scaled to 8 bits, colour numbers as they are. */
export async function samples(
  layout: Layout,
  size: Size,
  packed: Raster[],
  name: string,
): Promise<Raster> {
  const { channels, depth } = layout;
  const passes = (layout.interlaced ? PASSES : [[0, 0, 1, 1] as const])
    .map(([top, left, down, across]) => {
      const rows = Math.ceil((size.rows - top) / down);
      const cols = Math.ceil((size.cols - left) / across);
      return { top, left, down, across, rows, cols, bytes: Math.ceil((cols * channels * depth) / 8) };
    })
    .filter(({ rows, cols }) => rows > 0 && cols > 0);
  const needed = passes.reduce((sum, pass) => sum + pass.rows * (pass.bytes + 1), 0);
  const data = await unpack(packed, needed, name);
  const out = new Uint8Array(size.rows * size.cols * channels);
  const scale = layout.kind === "grey" ? 255 / (2 ** depth - 1) : 1;
  const step = Math.max(1, (channels * depth) >> 3);
  let at = 0;
  for (const pass of passes) {
    let above: Raster | null = null;
    for (let row = 0; row < pass.rows; row++) {
      const filter = data[at]!;
      const line: Raster = data.subarray(at + 1, at + 1 + pass.bytes);
      if (!undo(filter, line, above, step)) throw damaged(name, `it has no filter ${filter}`);
      at += pass.bytes + 1;
      above = line;
      const start = ((pass.top + pass.down * row) * size.cols + pass.left) * channels;
      spread(line, out, start, pass.cols, pass.across, channels, depth, scale);
    }
  }
  return out;
}

/** Undo a line's filter in place; return false if there is no such filter. */
function undo(filter: number, line: Raster, above: Raster | null, step: number): boolean {
  if (filter > 4) return false;
  for (let at = 0; filter !== 0 && at < line.length; at++) {
    const left = at < step ? 0 : line[at - step]!;
    const up = above ? above[at]! : 0;
    const corner = at < step || !above ? 0 : above[at - step]!;
    let guess = left;
    if (filter === 2) guess = up;
    else if (filter === 3) guess = (left + up) >> 1;
    else if (filter === 4) {
      const sum = left + up - corner;
      const [a, b, c] = [Math.abs(sum - left), Math.abs(sum - up), Math.abs(sum - corner)];
      guess = a <= b && a <= c ? left : b <= c ? up : corner;
    }
    line[at] = line[at]! + guess;
  }
  return true;
}

function spread(
  line: Raster,
  out: Raster,
  start: number,
  cols: number,
  across: number,
  channels: number,
  depth: number,
  scale: number,
): void {
  if (depth === 8) {
    for (let col = 0, from = 0; col < cols; col++) {
      const to = start + col * across * channels;
      for (let channel = 0; channel < channels; channel++) out[to + channel] = line[from++]!;
    }
    return;
  }
  const mask = 2 ** depth - 1;
  for (let col = 0; col < cols; col++) {
    const bit = col * depth;
    const value = (line[bit >> 3]! >> (8 - depth - (bit & 7))) & mask;
    out[start + col * across] = value * scale;
  }
}

/** Return how opaque each pixel is when a part of an animation is laid over what was there. */
export function opacities(layout: Layout, pixels: Raster): Raster {
  const { channels, holes, kind } = layout;
  const out = new Uint8Array(pixels.length / channels).fill(255);
  if (kind === "grey-alpha" || kind === "colour-alpha") {
    for (let at = 0; at < out.length; at++) out[at] = pixels[at * channels + channels - 1]!;
  } else if (kind === "palette" && holes) {
    for (let at = 0; at < out.length; at++) out[at] = holes[pixels[at]!] ?? 255;
  } else if (kind === "colour" && holes && holes.length >= 6) {
    for (let at = 0; at < out.length; at++) if (isHole(pixels, at * 3, holes)) out[at] = 0;
  }
  return out;
}

/** Return the luma of a picture, with black for what is transparent. */
export function lumaOf(layout: Layout, pixels: Raster): Raster {
  const { channels, holes, kind } = layout;
  const out = new Uint8Array(layout.rows * layout.cols);
  if (kind === "palette") {
    const shades = paletteLuma(layout.palette!, holes);
    for (let at = 0; at < out.length; at++) out[at] = shades[pixels[at]!]!;
  } else if (kind === "grey") {
    const raw = holes && holes.length >= 2 ? (holes[0]! << 8) | holes[1]! : -1;
    const hole = raw < 0 ? -1 : layout.depth === 1 ? (raw ? 255 : 0) : raw & 255;
    for (let at = 0; at < out.length; at++) out[at] = pixels[at] === hole ? 0 : pixels[at]!;
  } else if (kind === "grey-alpha") {
    for (let at = 0; at < out.length; at++) {
      out[at] = overBlack(pixels[2 * at]!, pixels[2 * at + 1]!);
    }
  } else {
    const key = kind === "colour" && holes && holes.length >= 6 ? holes : null;
    for (let at = 0, from = 0; at < out.length; at++, from += channels) {
      const alpha = kind === "colour-alpha" ? pixels[from + 3]! : 255;
      if (key && isHole(pixels, from, key)) continue;
      const [red, green, blue] = [pixels[from]!, pixels[from + 1]!, pixels[from + 2]!];
      out[at] =
        alpha === 255
          ? luma(red, green, blue)
          : luma(overBlack(red, alpha), overBlack(green, alpha), overBlack(blue, alpha));
    }
  }
  return out;
}

function isHole(pixels: Raster, at: number, key: Uint8Array): boolean {
  return pixels[at] === key[1] && pixels[at + 1] === key[3] && pixels[at + 2] === key[5];
}

/** Return the luma of 256 colours of three bytes each; colours that are missing are black. */
function paletteLuma(palette: Uint8Array, alphas: Uint8Array | null = null): Raster {
  return new Uint8Array(256).map((_, index) => {
    const alpha = alphas?.[index] ?? 255;
    const [red, green, blue] = [0, 1, 2].map((c) => overBlack(palette[3 * index + c] ?? 0, alpha));
    return luma(red!, green!, blue!);
  });
}
