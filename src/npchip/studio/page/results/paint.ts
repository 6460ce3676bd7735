/** Draws pictures and marks on canvases, without making objects that must be collected. */

import type { FrameBatch } from "../protocol";
import type { Guide } from "./guide";
import { type MarkKinds, type Marks, type Point, centerOf } from "./scene";

/** Share of the room that a picture must fill for the sake of equally large pixels. */
const WORTH = 0.93;

/** Colours of the marks, as in the thesis; shapes and dark rims tell them apart as well. */
export const INK = { path: "#26d05c", prediction: "#ff4238", box: "#40c8ff", rim: "#000" };

const SMALLEST_BOX = 16; // as the mark of the centre hides smaller ones

/** Grey pixels on a canvas of their own size. */
export class Grey {
  private readonly context: CanvasRenderingContext2D;
  private image: ImageData | null = null;
  private words = new Uint32Array(0);
  private readonly shades = new Uint32Array(256);
  private low = -1;
  private high = -1;

  constructor(readonly canvas = document.createElement("canvas")) {
    this.context = canvas.getContext("2d") as CanvasRenderingContext2D;
  }

  /** Take the pixels of a frame; `low` is drawn black and `high` white. */
  set(pixels: Uint8Array, rows: number, cols: number, low = 0, high = 255): void {
    if (!this.image || this.image.width !== cols || this.image.height !== rows) {
      this.canvas.width = cols;
      this.canvas.height = rows;
      this.image = this.context.createImageData(cols, rows);
      this.words = new Uint32Array(this.image.data.buffer);
    }
    this.stretch(low, high);
    const { words, shades } = this;
    for (let i = 0; i < words.length; i++) words[i] = shades[pixels[i] as number] as number;
    this.context.putImageData(this.image, 0, 0);
  }

  private stretch(low: number, high: number): void {
    if (low === this.low && high === this.high) return;
    this.low = low;
    this.high = high;
    for (let value = 0; value < 256; value++) {
      const part = high > low ? Math.floor(((value - low) * 255) / (high - low)) : value;
      const shade = Math.max(0, Math.min(255, part));
      this.shades[value] = 0xff000000 | (shade << 16) | (shade << 8) | shade;
    }
  }
}

/** Make a canvas as large as its box allows; return the CSS pixels per array pixel. */
export function fit(
  canvas: HTMLCanvasElement,
  box: DOMRectReadOnly,
  rows: number,
  cols: number,
): number {
  const ratio = window.devicePixelRatio || 1;
  const room = Math.min(box.width / cols, box.height / rows) * ratio;
  const even = Math.floor(room); // at whole factors all pixels are equally large
  const factor = Math.max(1, even >= WORTH * room ? even : room);
  const [width, height] = [Math.floor(cols * factor), Math.floor(rows * factor)];
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  // Apart from the pixels: the ratio changes when a window moves to another screen.
  const shown = `${width / ratio}px`;
  if (canvas.style.width !== shown) {
    canvas.style.width = shown;
    canvas.style.height = `${height / ratio}px`;
  }
  return width / ratio / cols;
}

/** Draw pixels enlarged, with sharp edges. */
export function enlarge(context: CanvasRenderingContext2D, source: HTMLCanvasElement): void {
  const { width, height } = context.canvas;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.imageSmoothingEnabled = false;
  context.drawImage(source, 0, 0, width, height);
}

/** The path of centres, on a layer that grows with the frames. */
export class PathLayer {
  readonly canvas = document.createElement("canvas");
  private readonly context = this.canvas.getContext("2d") as CanvasRenderingContext2D;
  private run: FrameBatch | undefined;
  private start = 0;
  private next = 0;
  private last: Point | null = null;
  private scale = 0;

  /** Draw the path of the frames from `start` to `frame`. */
  update(
    batches: readonly FrameBatch[],
    start: number,
    frame: number,
    kinds: MarkKinds,
    target: HTMLCanvasElement,
    scale: number,
  ): void {
    const { width, height } = target;
    const other = this.canvas.width !== width || this.canvas.height !== height;
    // A reset begins another run: its first frames are not those that were drawn.
    const reset = batches[0]?.first === 0 && this.run !== batches[0] && this.run?.first === 0;
    if (other || reset || scale !== this.scale || start !== this.start || frame < this.next - 1) {
      this.canvas.width = width;
      this.canvas.height = height;
      this.start = this.next = start;
      this.last = null;
      this.scale = scale;
    }
    this.run = batches[0];
    const { context } = this;
    const ratio = width / (scale * kinds.cols);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    // A batch may bring a thousand frames: all lines at once, and all discs, draw far sooner.
    const lines = new Path2D();
    const spots: Place[] = [];
    for (; this.next <= frame; this.next++) {
      const point = centerOf(batches, this.next, kinds);
      if (!point || (this.last && same(point, this.last))) continue;
      const place = at(point, scale);
      if (this.last) {
        const before = at(this.last, scale);
        lines.moveTo(before.x, before.y);
        lines.lineTo(place.x, place.y);
        if (!spots.length) spots.push(before);
      }
      spots.push(place);
      this.last = point;
    }
    if (!spots.length) return;
    context.lineCap = "round";
    stroke(context, lines, INK.path, 2);
    discs(context, spots, 2.2, INK.path);
  }
}

/** Draw the marks of a frame over its picture. */
export function drawMarks(
  context: CanvasRenderingContext2D,
  marks: Marks,
  cols: number,
  scale: number,
): void {
  const ratio = context.canvas.width / (scale * cols);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  const { center, predicted, box } = marks;
  if (box) {
    const [x, width] = atLeast(box.left * scale, (box.right + 1) * scale);
    const [y, height] = atLeast(box.top * scale, (box.bottom + 1) * scale);
    rectangle(context, x, y, width, height);
  }
  if (center && predicted) dashes(context, at(center, scale), at(predicted, scale));
  if (predicted) cross(context, at(predicted, scale), 6);
  if (center) discs(context, [at(center, scale)], 3.6, INK.path);
}

/** Draw the frame in which an object has to be. */
export function drawGuide(
  context: CanvasRenderingContext2D,
  [height, width]: Guide,
  rows: number,
  cols: number,
): void {
  const ratio = context.canvas.width / cols;
  context.setTransform(1, 0, 0, 1, 0, 0);
  const [x, y] = [((cols - width) / 2) * ratio, ((rows - height) / 2) * ratio];
  rectangle(context, x, y, width * ratio, height * ratio);
}

interface Place {
  x: number;
  y: number;
}

function at(point: Point, scale: number): Place {
  return { x: (point.column + 0.5) * scale, y: (point.row + 0.5) * scale };
}

function same(a: Point, b: Point): boolean {
  return a.row === b.row && a.column === b.column;
}

function line(
  context: CanvasRenderingContext2D,
  start: Place,
  end: Place,
  colour: string,
  width: number,
): void {
  const path = new Path2D();
  path.moveTo(start.x, start.y);
  path.lineTo(end.x, end.y);
  stroke(context, path, colour, width);
}

/** Draw lines with a dark rim. */
function stroke(
  context: CanvasRenderingContext2D,
  path: Path2D,
  colour: string,
  width: number,
): void {
  context.lineCap = "round";
  for (const [ink, wide] of [
    [INK.rim, width + 2],
    [colour, width],
  ] as const) {
    context.strokeStyle = ink;
    context.lineWidth = wide;
    context.stroke(path);
  }
}

function dashes(context: CanvasRenderingContext2D, start: Place, end: Place): void {
  context.setLineDash([6, 6]);
  line(context, start, end, INK.prediction, 1.8);
  context.setLineDash([]);
}

/** Draw discs with a dark rim. */
function discs(
  context: CanvasRenderingContext2D,
  centers: readonly Place[],
  radius: number,
  colour: string,
): void {
  for (const [ink, r] of [
    [INK.rim, radius + 1],
    [colour, radius],
  ] as const) {
    context.fillStyle = ink;
    context.beginPath();
    for (const { x, y } of centers) {
      context.moveTo(x + r, y);
      context.arc(x, y, r, 0, 2 * Math.PI);
    }
    context.fill();
  }
}

function cross(context: CanvasRenderingContext2D, { x, y }: Place, radius: number): void {
  context.lineCap = "butt";
  for (const [ink, width] of [
    [INK.rim, 5],
    [INK.prediction, 2.6],
  ] as const) {
    context.strokeStyle = ink;
    context.lineWidth = width;
    context.beginPath();
    context.moveTo(x - radius, y - radius);
    context.lineTo(x + radius, y + radius);
    context.moveTo(x - radius, y + radius);
    context.lineTo(x + radius, y - radius);
    context.stroke();
  }
}

function rectangle(
  context: CanvasRenderingContext2D,
  x: number,
  y: number,
  width: number,
  height: number,
): void {
  for (const [ink, wide] of [
    [INK.rim, 4],
    [INK.box, 1.8],
  ] as const) {
    context.strokeStyle = ink;
    context.lineWidth = wide;
    context.strokeRect(x, y, width, height);
  }
}

/** Return start and length of an interval, widened about its middle if it is too short. */
function atLeast(start: number, end: number): [number, number] {
  const spare = Math.max(0, SMALLEST_BOX - (end - start));
  return [start - spare / 2, end - start + spare];
}
