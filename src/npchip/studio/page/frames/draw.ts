/** Scenes that the reader draws: strokes of grey that move together over a background. */

import type { Clip } from "../protocol";
import { FramesError, type Size } from "./errors";
import { takeMemory } from "./take";

/** A stroke of a round brush through some pixels. */
export interface Stroke {
  points: { row: number; col: number }[];
  /** Diameter of the brush in pixels. */
  brush: number;
  /** 0 to 255, or null to rub out. */
  grey: number | null;
}

export interface Drawing extends Size {
  background: number;
  strokes: Stroke[];
  /** Pixels that everything drawn moves from one frame to the next, down and to the right. */
  motion: { rows: number; cols: number };
  frames: number;
}

/** Farthest place of a stroke from the first pixel: a pointer may leave the canvas. */
const FARTHEST = 1 << 14;
/** Largest brush, in pixels. */
export const MOST_BRUSH = 40;
/** Most frames of a drawn scene. */
export const MOST_FRAMES = 1000;
const NOTHING = -1;

/** Return the greys that strokes leave, -1 where there is nothing. */
export function painted({ rows, cols, strokes }: Pick<Drawing, "rows" | "cols" | "strokes">): Int16Array {
  const layer = new Int16Array(rows * cols).fill(NOTHING);
  for (const { points, brush, grey } of strokes) {
    const value = grey === null ? NOTHING : clamp(grey, 0, 255);
    let last = points[0];
    for (const point of points) {
      const steps = Math.max(1, Math.abs(point.row - last!.row), Math.abs(point.col - last!.col));
      for (let step = 0; step <= steps; step++) {
        const row = Math.round(last!.row + ((point.row - last!.row) * step) / steps);
        const col = Math.round(last!.col + ((point.col - last!.col) * step) / steps);
        stamp(layer, { rows, cols }, row, col, brush, value);
      }
      last = point;
    }
  }
  return layer;
}

/** Put a disc down; one of an even diameter reaches half a pixel further up and to the left. */
function stamp(
  layer: Int16Array,
  { rows, cols }: Size,
  row: number,
  col: number,
  brush: number,
  value: number,
): void {
  const centre = brush % 2 === 0 ? -0.5 : 0;
  const reach = Math.ceil(brush / 2);
  for (let y = -reach; y <= reach; y++) {
    for (let x = -reach; x <= reach; x++) {
      if (4 * ((y - centre) ** 2 + (x - centre) ** 2) > brush ** 2) continue;
      const [r, c] = [row + y, col + x];
      if (r >= 0 && r < rows && c >= 0 && c < cols) layer[r * cols + c] = value;
    }
  }
}

/** Return a frame: what is painted, moved by whole pixels; what leaves the picture is gone. */
export function drawnFrame(
  layer: Int16Array,
  drawing: Drawing,
  index: number,
  out: Uint8Array = new Uint8Array(layer.length),
): Uint8Array {
  const { rows, cols, motion } = drawing;
  const down = Math.floor(motion.rows * index + 0.5);
  const right = Math.floor(motion.cols * index + 0.5);
  out.fill(clamp(drawing.background, 0, 255));
  for (let row = Math.max(0, down); row < Math.min(rows, rows + down); row++) {
    for (let col = Math.max(0, right); col < Math.min(cols, cols + right); col++) {
      const value = layer[(row - down) * cols + col - right]!;
      if (value !== NOTHING) out[row * cols + col] = value;
    }
  }
  return out;
}

/** Return what was kept of a drawing if it is one, else null. */
export function drawingIn(found: unknown): Drawing | null {
  const { rows, cols, background, strokes, motion, frames } = Object(found) as Record<string, unknown>;
  const { rows: down, cols: right } = Object(motion) as Record<string, unknown>;
  const numbers = [rows, cols, background, down, right, frames];
  if (!numbers.every(Number.isFinite) || !Array.isArray(strokes) || !strokes.every(isStroke)) return null;
  return found as Drawing;
}

function isStroke(found: unknown): found is Stroke {
  const { points, brush, grey } = Object(found) as Record<string, unknown>;
  const isPoint = (point: unknown): boolean => {
    const { row, col } = Object(point) as Record<string, unknown>;
    return [row, col].every((at) => Number.isInteger(at) && Math.abs(at as number) <= FARTHEST);
  };
  const isGrey = grey === null || Number.isFinite(grey);
  return Array.isArray(points) && points.every(isPoint) && isGrey && Number.isFinite(brush) && (brush as number) <= MOST_BRUSH;
}

/** Make a clip of a drawing. */
export function drawnClip(drawing: Drawing): Clip {
  const { rows, cols, frames } = drawing;
  if (!Number.isInteger(frames) || frames < 1 || frames > MOST_FRAMES) {
    throw new FramesError("NP215", `scene: ${frames} frames`, `Choose 1 to ${MOST_FRAMES} frames`);
  }
  const layer = painted(drawing);
  const data = takeMemory(frames * rows * cols, "scene");
  for (let index = 0; index < frames; index++) {
    drawnFrame(layer, drawing, index, data.subarray(index * rows * cols, (index + 1) * rows * cols));
  }
  return { name: "drawn scene", count: frames, rows, cols, data, fps: null };
}

function clamp(value: number, least: number, most: number): number {
  return Math.min(most, Math.max(least, Math.round(value)));
}
