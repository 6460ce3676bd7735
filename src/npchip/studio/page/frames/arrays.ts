/** Frames of a `.npy` file: its shape, type and values are checked as npchip's Python does. */

import type { Clip } from "../protocol";
import { breathe } from "./bytes";
import { damaged, type Fit, FramesError, noFrames, type Size, SizeError } from "./errors";
import { checkSize, fitPicture, sameSize } from "./fit";
import { HEAD, type NpyHeader, objects, readHeader } from "./npy";
import { type Progress, takeMemory } from "./take";

/** Bytes read at once. */
const AT_ONCE = 1 << 22;

/** Read the frames of a `.npy` file. */
export async function openNpy(
  file: File,
  size: Size,
  fit: Fit | null,
  onProgress: Progress,
  signal: AbortSignal,
): Promise<Clip> {
  const { name } = file;
  const header = readHeader(await bytesOf(file, 0, HEAD), name);
  const { shape, bytes } = header;
  if (header.kind === "O") throw objects(name);
  const count = shape.reduce((product, length) => product * length, 1);
  if (bytes > 0) await checkLength(file, header, count * bytes);
  checkType(header, name);
  const clip = checkShape(shape, size, fit, name);
  const pixels = clip.rows * clip.cols;
  const values = takeMemory(header.fortran ? count : clip.count * size.rows * size.cols, name);
  const range: [bigint, bigint] = [0n, 0n];
  const frames = header.fortran
    ? values
    : takeMemory(Math.min(clip.count, Math.max(1, Math.floor(AT_ONCE / pixels))) * pixels, name);
  const batch = header.fortran ? count : frames.length;
  for (let done = 0; done < count; done += batch) {
    const now = Math.min(batch, count - done);
    for (let part = 0; part < now; part += AT_ONCE) {
      await breathe(signal);
      const some = Math.min(AT_ONCE, now - part);
      const from = header.start + (done + part) * bytes;
      const data = await bytesOf(file, from, from + some * bytes);
      convert(data, header, frames.subarray(part, part + some), range);
      onProgress((done + part + some) / count);
    }
    if (!header.fortran) fitAll(frames.subarray(0, now), clip, size, fit, name, values, done / pixels);
  }
  checkRange(range, header.type, name);
  let data = values;
  if (header.fortran) {
    const ordered = cOrder(values, shape.length === 2 ? [1, ...shape] : shape);
    data = takeMemory(clip.count * size.rows * size.cols, name);
    fitAll(ordered, clip, size, fit, name, data, 0);
  }
  return { name, count: clip.count, rows: size.rows, cols: size.cols, data, fps: null };
}

async function bytesOf(file: Blob, from: number, to: number): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array(await file.slice(from, to).arrayBuffer());
}

async function checkLength(file: File, header: NpyHeader, needed: number): Promise<void> {
  const held = file.size - header.start;
  const { name } = file;
  const shape = tuple(header.shape);
  if (needed > held) {
    const reason = `shape ${shape} of ${header.type} takes ${needed} bytes, the file holds ${held}`;
    throw damaged(name, reason);
  }
  if (needed === held) return;
  const end = header.start + needed;
  const next = await bytesOf(file, end, end + 6);
  if (next[0] === 0x93 && String.fromCharCode(...next.subarray(1)) === "NUMPY") {
    throw new FramesError(
      "NP216",
      `${name}: expected one array, found another behind it`,
      "Join them into one file: np.save(path, np.concatenate(arrays))",
    );
  }
  throw damaged(name, `${file.size - end} bytes follow the array that its header describes`);
}

function checkType({ kind, type }: NpyHeader, name: string): void {
  if (kind === "u" || kind === "i") return;
  const ways: Record<string, string> = {
    b: "Convert it with frames.astype(np.uint8) * 255",
    f: "Convert it with (frames * 255).round().clip(0, 255).astype(np.uint8) if they are 0 to 1, else without * 255",
  };
  throw new FramesError(
    "NP219",
    `${name}: expected whole numbers (uint8), found ${type}`,
    ways[kind] ?? null,
  );
}

/** Check a shape; return it as frames. */
function checkShape(shape: number[], size: Size, fit: Fit | null, name: string): Size & { count: number } {
  const last = shape.at(-1) ?? 0;
  const deep = shape.length === 3;
  if ((shape.length !== 2 && !deep) || (deep && last > 0 && last <= 4)) {
    throw new FramesError(
      "NP216",
      `${name}: expected shape (T, rows, columns) or (rows, columns), found ${tuple(shape)}`,
      shapeHelp(shape),
    );
  }
  const [count, rows, cols] = (deep ? shape : [1, ...shape]) as [number, number, number];
  if (count === 0) throw noFrames(name);
  const found = { rows, cols };
  const timeLast = deep && !sameSize(found, size) && looksLikeTimeLast(shape, size);
  try {
    checkSize(found, size, timeLast ? null : fit, name);
  } catch (error) {
    if (!(error instanceof SizeError)) throw error;
    if (timeLast) {
      const help = "The frames seem to lie along the last axis: np.moveaxis(frames, -1, 0)";
      throw new FramesError(error.code, error.text, help); // fitting would not mend it
    }
    if (rows === size.cols && cols === size.rows) {
      const help = "Rows and columns seem exchanged: frames.swapaxes(-1, -2)";
      throw new SizeError(name, found, size, help);
    }
    throw error;
  }
  return { count, rows, cols };
}

function shapeHelp(shape: number[]): string | null {
  const last = shape.at(-1);
  if (shape.length >= 3 && last === 1) return "Drop the last axis: frames[..., 0]";
  if (shape.length === 4 && shape[1] === 1) return "Drop the second axis: frames[:, 0]";
  if (shape.length === 4 && (shape[1] === 3 || shape[1] === 4)) {
    return "The second axis looks like colour: convert it to luma with np.tensordot(frames[:, :3], [0.299, 0.587, 0.114], (1, 0)).round().astype(np.uint8)";
  }
  if (shape.length >= 3 && (last === 3 || last === 4)) {
    return "The last axis looks like colour: convert it to luma with (frames[..., :3] @ [0.299, 0.587, 0.114]).round().astype(np.uint8)";
  }
  return null;
}

/** Guess that an array is (rows, columns, T): its first two axes are a picture's. */
function looksLikeTimeLast(shape: number[], size: Size): boolean {
  const [rows, cols, times] = shape as [number, number, number];
  const { rows: r, cols: c } = size;
  if ((rows === r && cols === c) || (rows === c && cols === r)) return true;
  const usual = [[r, c], [3, 4], [9, 16], [2, 3], [1, 1]] as [number, number][];
  return (
    Math.max(cols, times) > 3 * Math.min(cols, times) &&
    usual.some(([a, b]) => rows * b === cols * a || rows * a === cols * b) &&
    Math.min(rows, cols) > times
  );
}

/** Convert integers to bytes and widen the range of values that were met. */
function convert(data: Uint8Array, header: NpyHeader, out: Uint8Array, range: [bigint, bigint]): void {
  const { bytes, little, kind } = header;
  if (kind === "u" && bytes === 1) {
    out.set(data);
    return;
  }
  const low = little ? 0 : bytes - 1;
  for (let at = 0, from = 0; at < out.length; at++, from += bytes) {
    let high = kind === "i" && bytes === 1 ? data[from]! & 0x80 : 0;
    for (let byte = 0; byte < bytes; byte++) if (byte !== low) high |= data[from + byte]!;
    out[at] = data[from + low]!;
    if (high !== 0) widen(range, integer(data.subarray(from, from + bytes), header));
  }
}

function integer(bytes: Uint8Array, { little, kind }: NpyHeader): bigint {
  let value = 0n;
  for (const byte of little ? [...bytes].reverse() : bytes) value = (value << 8n) | BigInt(byte);
  return kind === "i" ? BigInt.asIntN(8 * bytes.length, value) : value;
}

function widen(range: [bigint, bigint], value: bigint): void {
  if (value < range[0]) range[0] = value;
  if (value > range[1]) range[1] = value;
}

function checkRange([low, high]: [bigint, bigint], type: string, name: string): void {
  if (low >= 0n && high <= 255n) return;
  const bits = high.toString(2).length;
  const help = `Keep the upper 8 of ${bits} bits: (frames >> ${bits - 8}).astype(np.uint8)`;
  const reach = low < 0n && high <= 255n ? `values down to ${low}` : `values up to ${high}`;
  throw new FramesError(
    "NP220",
    `${name}: expected values from 0 to 255, found ${low < 0n && high > 255n ? `${low} to ${high}` : reach} (${type})`,
    low >= 0n ? help : null,
  );
}

/** Put values in the order of rows that lie in the order of columns. */
function cOrder(values: Uint8Array, shape: number[]): Uint8Array<ArrayBuffer> {
  const [count, rows, cols] = shape as [number, number, number];
  const out = new Uint8Array(values.length);
  let at = 0;
  for (let frame = 0; frame < count; frame++) {
    for (let row = 0; row < rows; row++) {
      for (let col = 0; col < cols; col++) out[at++] = values[frame + count * (row + rows * col)]!;
    }
  }
  return out;
}

function fitAll(
  frames: Uint8Array<ArrayBuffer>,
  found: Size,
  size: Size,
  fit: Fit | null,
  name: string,
  out: Uint8Array,
  first: number,
): void {
  const pixels = found.rows * found.cols;
  for (let index = 0; index * pixels < frames.length; index++) {
    const data = frames.subarray(index * pixels, (index + 1) * pixels);
    const fitted = fitPicture({ rows: found.rows, cols: found.cols, data }, size, fit, name);
    out.set(fitted.data, (first + index) * size.rows * size.cols);
  }
}

/** Write a shape as Python does. */
function tuple(shape: number[]): string {
  return shape.length === 1 ? `(${shape[0]},)` : `(${shape.join(", ")})`;
}
