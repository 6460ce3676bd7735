/** Fitting a picture to the size of the sensor, bit for bit as npchip's Python does. */

import { type Fit, FramesError, type Size, SizeError, sizeText } from "./errors";
import type { Picture } from "./luma";

/** Longest side of a picture to resize; npchip has the same limit. */
const MAX_SIDE = 1 << 15;

/** Throw for a size that `fit` cannot change to the wanted one; `SizeError` if there is no `fit`. */
export function checkSize(found: Size, wanted: Size, fit: Fit | null, name: string): void {
  if (found.rows === 0 || found.cols === 0) {
    throw new FramesError("NP216", `${name}: frames of ${sizeText(found)} hold no pixels`);
  }
  if (fit === "resize" && Math.max(found.rows, found.cols) > MAX_SIDE) {
    throw new FramesError(
      "NP222",
      `${name}: frames of ${sizeText(found)} have a side longer than ${MAX_SIDE}`,
    );
  }
  if (sameSize(found, wanted) || fit === "resize") return;
  if (fit === null) throw new SizeError(name, found, wanted);
  if (found.rows < wanted.rows || found.cols < wanted.cols) {
    throw new FramesError(
      "NP218",
      `${name}: cannot crop frames of ${sizeText(found)} (rows x columns) to ${sizeText(wanted)}`,
      "Resize also enlarges",
    );
  }
}

export function sameSize(one: Size, other: Size): boolean {
  return one.rows === other.rows && one.cols === other.cols;
}

/** Fit a picture to a size; a picture of that size is returned itself. */
export function fitPicture(picture: Picture, size: Size, fit: Fit | null, name: string): Picture {
  checkSize(picture, size, fit, name);
  if (sameSize(picture, size)) return picture;
  if (fit === "resize") return averageAreas(picture, size);
  const top = (picture.rows - size.rows) >> 1;
  const left = (picture.cols - size.cols) >> 1;
  return cut(picture, top, left, size);
}

/** Cut a part out of a picture. */
export function cut(picture: Picture, top: number, left: number, size: Size): Picture {
  const data = new Uint8Array(size.rows * size.cols);
  for (let row = 0; row < size.rows; row++) {
    const start = (top + row) * picture.cols + left;
    data.set(picture.data.subarray(start, start + size.cols), row * size.cols);
  }
  return { ...size, data };
}

/**
 * Average the source area under each pixel, with halves rounded up.
 *
 * All sums are whole numbers: at most 2 * 255 * 2^30, which a number holds exactly.
 */
export function averageAreas(picture: Picture, size: Size): Picture {
  const { rows, cols, data } = picture;
  const area = rows * cols;
  const out = new Uint8Array(size.rows * size.cols);
  const across = edges(cols, size.cols);
  const before = new Int32Array(cols + 1);
  const line = new Float64Array(size.cols);
  const sums = new Float64Array(size.cols);
  let target = 0; // row of `out` that is being summed up
  let missing = rows; // what it still lacks, in units of 1 / size.rows source rows
  for (let row = 0; row < rows; row++) {
    addUp(data, row * cols, cols, across, before, line);
    let left = size.rows;
    while (left > 0) {
      const part = Math.min(left, missing);
      for (let col = 0; col < line.length; col++) sums[col]! += part * line[col]!;
      left -= part;
      missing -= part;
      if (missing > 0) continue;
      const start = target * size.cols;
      for (let col = 0; col < line.length; col++) {
        out[start + col] = Math.floor((2 * sums[col]! + area) / (2 * area));
      }
      sums.fill(0);
      target++;
      missing = rows;
    }
  }
  return { ...size, data: out };
}

interface Edges {
  /** Whole source pixels before each edge. */
  whole: Int32Array;
  /** Rest of the edge's place, in units of 1 / target source pixels. */
  part: Int32Array;
  target: number;
}

function edges(source: number, target: number): Edges {
  const whole = new Int32Array(target + 1);
  const part = new Int32Array(target + 1);
  for (let edge = 0; edge <= target; edge++) {
    whole[edge] = Math.floor((edge * source) / target);
    part[edge] = (edge * source) % target;
  }
  return { whole, part, target };
}

/** Add up what each target pixel covers of a line, in units of 1 / target source pixels. */
function addUp(
  data: Uint8Array,
  start: number,
  cols: number,
  { whole, part, target }: Edges,
  before: Int32Array,
  line: Float64Array,
): void {
  let sum = 0;
  for (let col = 0; col < cols; col++) {
    sum += data[start + col]!;
    before[col + 1] = sum;
  }
  let last = 0;
  for (let col = 0; col < target; col++) {
    const at = whole[col + 1]!;
    const rest = part[col + 1]!;
    const reached = target * before[at]! + (rest === 0 ? 0 : rest * data[start + at]!);
    line[col] = reached - last;
    last = reached;
  }
}
