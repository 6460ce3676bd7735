/** Selects what is drawn over the picture, by the rules of `npchip run --render`. */

import type { FrameBatch, ProgramInfo } from "../protocol";
import { type Column, type Source, inputFrame, isImage, numberIn } from "./frames";

/** A pixel of the sensor. */
export interface Point {
  row: number;
  column: number;
}

/** Bounds of pixels, inclusive. */
export interface Box {
  top: number;
  left: number;
  bottom: number;
  right: number;
}

/** The marks of a frame. */
export interface Marks {
  center: Point | null;
  /** The predicted centre of the next frame. */
  predicted: Point | null;
  /** The pixels that moved. */
  box: Box | null;
}

/** Kinds of a program's marks: the legend explains these. */
export interface MarkKinds {
  /** Names of the outputs that say where the object is; null without. */
  place: readonly [string, string] | null;
  prediction: boolean;
  /** Number of frames that the prediction is ahead. */
  ahead: number;
  box: boolean;
  /** A pixel moves if it changes by so much; null if the program does not say. */
  threshold: number | null;
  /** True if an output `valid` says whether there is a centre. */
  valid: boolean;
  /** Columns of the sensor. */
  cols: number;
}

const CENTER = ["center_row", "center_col"] as const;
const PLACE = ["row", "col"] as const;
const PREDICTED = ["predicted_row", "predicted_col"] as const;

/** Name of the input frame among the pictures; no output has it, as names have no blank. */
export const INPUT = "input frame";

/** Return which marks a program has. */
export function markKinds(program: ProgramInfo | null, columns: readonly Column[]): MarkKinds {
  const names = new Set(columns.map((column) => column.name));
  const has = (outputs: readonly string[]): boolean => outputs.every((name) => names.has(name));
  // Places of several objects are lists, which only `--render` draws.
  const single = has([...PLACE, ...PREDICTED]) && !names.has("id");
  const place = has(CENTER) ? CENTER : single ? PLACE : null;
  const threshold = place === CENTER ? (program?.symbols["THRESHOLD"] ?? null) : null;
  return {
    place,
    prediction: place !== null && names.has("predicted_row"),
    ahead: program?.symbols["AHEAD"] ?? 1,
    box: threshold !== null,
    threshold,
    valid: names.has("valid"),
    cols: program ? sensorOf(program).cols : 0,
  };
}

/** Return the marks of a frame. */
export function marksOf(
  batches: readonly FrameBatch[],
  frame: number,
  kinds: MarkKinds,
  source: Source,
): Marks {
  const center = centerOf(batches, frame, kinds);
  return {
    center,
    predicted: center && pointOf(batches, PREDICTED, frame),
    box: moving(batches, frame, kinds, source),
  };
}

/** Return the centre of a frame; null if it is missing or marked invalid. */
export function centerOf(
  batches: readonly FrameBatch[],
  frame: number,
  kinds: MarkKinds,
): Point | null {
  if (!kinds.place || (kinds.valid && !numberIn(batches, "valid", frame))) return null;
  return pointOf(batches, kinds.place, frame);
}

/** Return the bounds of the pixels that changed by the threshold since the frame before. */
export function moving(
  batches: readonly FrameBatch[],
  frame: number,
  { threshold, cols }: MarkKinds,
  source: Source,
): Box | null {
  if (threshold === null) return null;
  const now = inputFrame(batches, frame, source);
  const before = inputFrame(batches, frame - 1, source);
  if (!now || !before) return null;
  let top = -1;
  let bottom = -1;
  let left = cols;
  let right = -1;
  for (let i = 0, row = 0; i < now.length; row++) {
    for (let column = 0; column < cols; column++, i++) {
      if (Math.abs((now[i] as number) - (before[i] as number)) < threshold) continue;
      if (top < 0) top = row;
      bottom = row;
      if (column < left) left = column;
      if (column > right) right = column;
    }
  }
  return top < 0 ? null : { top, left, bottom, right };
}

/** Return the size of the sensor: 8 × 8 pixels belong to each NP. */
export function sensorOf(program: ProgramInfo): { rows: number; cols: number } {
  return { rows: program.machine.np_rows * 8, cols: program.machine.np_cols * 8 };
}

/** Return the name of what is drawn large if the reader chose nothing, as `--render` does. */
export function defaultPicture(
  program: ProgramInfo | null,
  columns: readonly Column[],
  hasInput: boolean,
): string | null {
  const picture = program?.outputs.find((output) => output.kind === "picture");
  if (picture) return picture.name;
  if (hasInput) return INPUT;
  return columns.find(isImage)?.name ?? null;
}

/** Say in words what the marks show. */
export function describe(frame: number, marks: Marks, kinds: MarkKinds): string {
  const parts = [`frame ${frame}`];
  if (kinds.place) {
    parts.push(marks.center ? `centre at ${place(marks.center)}` : "no centre");
  }
  if (kinds.prediction && marks.predicted) {
    const when = kinds.ahead === 1 ? "next predicted" : `predicted ${kinds.ahead} frames ahead`;
    parts.push(`${when} at ${place(marks.predicted)}`);
  }
  if (marks.box) {
    const { top, left, bottom, right } = marks.box;
    parts.push(`moving pixels in rows ${top} to ${bottom}, columns ${left} to ${right}`);
  }
  return parts.join("; ");
}

function place(point: Point): string {
  return `row ${point.row}, column ${point.column}`;
}

function pointOf(
  batches: readonly FrameBatch[],
  names: readonly [string, string],
  frame: number,
): Point | null {
  const [row, column] = names.map((name) => numberIn(batches, name, frame)) as [number | null, number | null];
  return row === null || column === null ? null : { row, column };
}
