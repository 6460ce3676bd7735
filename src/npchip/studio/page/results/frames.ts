/** Looks frames up in the batches of a run. */

import type { Clip, FrameBatch, FrameDocument, Output, ProgramInfo, Value } from "../protocol";

/** A frame's outputs as the chip sent them; null for nothing sent, undefined for no longer kept. */
export type Sent = number | number[] | Uint8Array | null | undefined;

/** An output of a run: one that the program names, or a port without a name that was sent to. */
export interface Column {
  name: string;
  kind: Output["kind"];
  /** Size of its planes or pictures; 0 for numbers, and as long as nothing was sent. */
  rows: number;
  cols: number;
}

/** Return the index of the first frame that is kept. */
export function firstFrame(batches: readonly FrameBatch[]): number {
  return batches[0]?.first ?? 0;
}

/** Return the index after the newest frame. */
export function endFrame(batches: readonly FrameBatch[]): number {
  const last = batches[batches.length - 1];
  return last ? last.first + last.cycles.length : 0;
}

/** Return what came before the first frame; undefined if it is not known. */
export function setupOf(batches: readonly FrameBatch[]): FrameDocument | undefined {
  return batches[0]?.setup;
}

/** Return the batch that holds a frame; undefined if none does. */
export function batchOf(batches: readonly FrameBatch[], frame: number): FrameBatch | undefined {
  let low = 0;
  let high = batches.length - 1;
  while (low <= high) {
    const middle = (low + high) >> 1;
    const batch = batches[middle] as FrameBatch;
    if (frame < batch.first) high = middle - 1;
    else if (frame >= batch.first + batch.cycles.length) low = middle + 1;
    else return batch;
  }
  return undefined;
}

/** Return the cycles of a frame; undefined if it is not kept. */
export function cyclesOf(batches: readonly FrameBatch[], frame: number): number | undefined {
  const batch = batchOf(batches, frame);
  return batch?.cycles[frame - batch.first];
}

/** Index that stands for the setup, which comes before the first frame. */
export const SETUP = -1;

/** Return what a frame sent to an output. */
export function sentIn(batches: readonly FrameBatch[], name: string, frame: number): Sent {
  if (frame === SETUP) return flat(setupOf(batches)?.outputs[name] ?? null);
  const batch = batchOf(batches, frame);
  return batch && sentAt(batch, name, frame - batch.first);
}

/** Return what the frame at a place of a batch sent to an output. */
export function sentAt(batch: FrameBatch, name: string, at: number): Sent {
  const column = batch.outputs[name];
  if (!column) return null;
  const value = column.values[at];
  return typeof value === "number" && Number.isNaN(value) ? null : value;
}

function flat(value: Value): Sent {
  if (Array.isArray(value) && Array.isArray(value[0])) return Uint8Array.from(value.flat());
  return value as number | number[] | null;
}

/** Return the number that a frame sent to an output; null if it sent none. */
export function numberIn(
  batches: readonly FrameBatch[],
  name: string,
  frame: number,
): number | null {
  const value = sentIn(batches, name, frame);
  return typeof value === "number" ? value : null;
}

/** The chip's input: a clip, whose frames batches need not bring, or frames of a camera. */
export type Source = Clip | "live" | null;

/** Return an input frame, row by row; null if it is not kept. */
export function inputFrame(
  batches: readonly FrameBatch[],
  frame: number,
  source: Source,
): Uint8Array | null {
  const batch = batchOf(batches, frame);
  if (batch?.frames) return nth(batch.frames, frame - batch.first, batch.cycles.length);
  if (!source || source === "live" || frame < 0 || frame >= source.count) return null;
  return nth(source.data, frame, source.count);
}

/** Return one of `count` equal parts of bytes. */
function nth(bytes: Uint8Array, index: number, count: number): Uint8Array {
  const size = bytes.length / count;
  return bytes.subarray(index * size, (index + 1) * size);
}

/** Return the outputs of a run in their order: those with a name, then ports without one. */
export function columnsOf(
  program: ProgramInfo | null,
  batches: readonly FrameBatch[],
): Column[] {
  const columns = new Map<string, Column>();
  for (const { name, kind } of program?.outputs ?? []) {
    columns.set(name, { name, kind, rows: 0, cols: 0 });
  }
  const unnamed = new Map<string, Column>();
  for (const [name, value] of Object.entries(setupOf(batches)?.outputs ?? {})) {
    if (!Array.isArray(value) || !Array.isArray(value[0])) continue;
    const size = { rows: value.length, cols: value[0].length };
    const named = columns.get(name);
    if (named) Object.assign(named, size);
    else unnamed.set(name, { name, kind: "plane", ...size });
  }
  for (const batch of batches) {
    for (const name in batch.outputs) {
      const sent = batch.outputs[name];
      if (!sent) continue;
      let column = columns.get(name) ?? unnamed.get(name);
      if (!column) {
        column = { name, kind: sent.kind, rows: 0, cols: 0 };
        unnamed.set(name, column);
      }
      if ("rows" in sent && sent.rows) {
        column.rows = sent.rows;
        column.cols = sent.cols;
      }
    }
  }
  const ports = [...unnamed.values()].sort((a, b) => portOf(a.name) - portOf(b.name));
  return [...columns.values(), ...ports];
}

function portOf(name: string): number {
  return Number.parseInt(name.replace("port", ""), 10);
}

/** Return whether an output's values are planes or pictures. */
export function isImage(column: Column): boolean {
  return column.kind === "plane" || column.kind === "picture";
}

/** Return the index of the first frame from which on planes and pictures are kept. */
export function firstWithImages(batches: readonly FrameBatch[]): number {
  for (let at = batches.length - 1; at >= 0; at--) {
    const batch = batches[at] as FrameBatch;
    if (batch.cycles.length && isStripped(batch)) return batch.first + batch.cycles.length;
  }
  return firstFrame(batches);
}

/** Return whether a batch has planes or pictures that are no longer kept. */
function isStripped(batch: FrameBatch): boolean {
  return Object.values(batch.outputs).some(
    (column) =>
      (column.kind === "plane" || column.kind === "picture") &&
      column.values.length < batch.cycles.length,
  );
}

const ranges = new WeakMap<FrameBatch, Map<string, [number, number]>>();

/** Return the least and greatest number of an output's kept planes; null if there are none. */
export function rangeOf(batches: readonly FrameBatch[], name: string): [number, number] | null {
  let low = 256;
  let high = -1;
  for (const batch of batches) {
    const [least, most] = batchRange(batch, name);
    if (least < low) low = least;
    if (most > high) high = most;
  }
  return high < 0 ? null : [low, high];
}

function batchRange(batch: FrameBatch, name: string): [number, number] {
  let known = ranges.get(batch);
  if (!known) ranges.set(batch, (known = new Map()));
  let range = known.get(name);
  if (range) return range;
  range = [256, -1];
  const column = batch.outputs[name];
  if (column && "rows" in column) {
    for (const plane of column.values) if (plane) widen(range, plane);
  }
  known.set(name, range);
  return range;
}

const extremesOf = new WeakMap<Uint8Array, [number, number]>();

/** Return the least and greatest number of a plane or picture, which is not changed any more. */
export function extremes(plane: Uint8Array): [number, number] {
  let range = extremesOf.get(plane);
  if (!range) {
    range = [256, -1];
    widen(range, plane);
    extremesOf.set(plane, range);
  }
  return range;
}

function widen(range: [number, number], plane: Uint8Array): void {
  let [low, high] = range;
  for (let i = 0; i < plane.length; i++) {
    const value = plane[i] as number;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  range[0] = low;
  range[1] = high;
}
