/** The moving picture with its marks, and beside it all other pictures and values of the frame. */

import { effect, signal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { batches, clip, program } from "../store";
import { FrameSlider } from "./slider";
import { Legend, pathLength, pathStart } from "./legend";
import { PictureCard, shades } from "./card";
import { Values } from "./values";
import { type Column, inputFrame, isImage, sentIn } from "./frames";
import { guide } from "./guide";
import { Grey, PathLayer, drawGuide, drawMarks, enlarge, fit } from "./paint";
import { INPUT, defaultPicture, describe, markKinds, marksOf, sensorOf } from "./scene";
import { columns, shown, useSlowly } from "./shown";

/** Name of the picture that the reader wants large; null to leave it to the program. */
const wanted = signal<string | null>(null);

/** Return what can be drawn: the input frame first, then the outputs. */
function pictures(): Column[] {
  const now = program.value;
  const input = now?.exposes && hasInput();
  const images = columns.value.filter(isImage);
  if (!now || !input) return images;
  return [{ name: INPUT, kind: "picture", ...sensorOf(now) }, ...images];
}

function hasInput(): boolean {
  const { value } = clip;
  return (value !== null && value !== "live") || batches.value.some((batch) => batch.frames);
}

function largeName(all: readonly Column[]): string | null {
  if (all.some((column) => column.name === wanted.value)) return wanted.value;
  return defaultPicture(program.value, columns.value, all[0]?.name === INPUT);
}

/** Return the pixels of a picture in the frame that is shown. */
function pixelsOf(name: string): Uint8Array | null {
  const frame = shown.value;
  // Before the first frame, what the chip will see is shown.
  if (name === INPUT) return inputFrame(batches.value, Math.max(0, frame), clip.value);
  const sent = sentIn(batches.value, name, frame);
  return sent instanceof Uint8Array ? sent : null;
}

/** Draw the large picture with each frame. Only signals are read before it is scheduled. */
function usePainter(): {
  box: { current: HTMLDivElement | null };
  canvas: { current: HTMLCanvasElement | null };
} {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const grey = new Grey();
    const path = new PathLayer();
    const size = signal<DOMRectReadOnly | null>(null);
    let request = 0;
    const paint = (): void => {
      request = 0;
      const target = canvas.current;
      const context = target?.getContext("2d");
      const all = pictures();
      const column = all.find((each) => each.name === largeName(all));
      if (!target || !context || !column?.rows || !size.value?.width) return;
      const { rows, cols } = column;
      const scale = fit(target, size.value, rows, cols);
      // Small differences would be black on black in the range of all bytes.
      const [low, high] = shades(column);
      grey.set(pixelsOf(column.name) ?? new Uint8Array(rows * cols), rows, cols, low, high);
      enlarge(context, grey.canvas);
      if (column.name === INPUT && guide.value) drawGuide(context, guide.value, rows, cols);
      const kinds = markKinds(program.value, columns.value);
      if (!kinds.place || cols !== kinds.cols || shown.value < 0) return;
      const start = pathStart(shown.value);
      if (start !== null) {
        path.update(batches.value, start, shown.value, kinds, target, scale);
        context.setTransform(1, 0, 0, 1, 0, 0);
        context.drawImage(path.canvas, 0, 0);
      }
      const marks = marksOf(batches.value, shown.value, kinds, clip.value);
      drawMarks(context, marks, cols, scale);
    };
    const schedule = (): void => {
      if (!request) request = requestAnimationFrame(paint);
    };
    const observer = new ResizeObserver(([entry]) => {
      size.value = entry?.contentRect ?? null;
    });
    if (box.current) observer.observe(box.current);
    const dispose = effect(() => {
      // Read what the picture depends on, so that a change of it draws anew.
      void [batches.value, shown.value, program.value, clip.value];
      void [wanted.value, size.value, pathLength.value, guide.value];
      schedule();
    });
    return () => {
      dispose();
      observer.disconnect();
      cancelAnimationFrame(request);
    };
  }, []);
  return { box, canvas };
}

/** The picture, its marks and its values, with a slider over the frames. */
export function Pictures(): JSX.Element {
  const { box, canvas } = usePainter();
  const { all, large, kinds, empty } = useSlowly(read, 250);
  const label = useSlowly(() => labelOf(largeName(pictures())), 1000);
  return (
    <div class="results-pictures">
      <div class="results-stage">
        <div class="results-large" ref={box}>
          <canvas ref={canvas} role="img" aria-label={label} hidden={large === null} />
          {large === null && <p class="results-empty">{empty}</p>}
        </div>
        <div class="results-side">
          {all.length > 0 && (
            <div class="results-cards" role="group" aria-label="Picture to show large">
              {all.map((column) => (
                <PictureCard
                  key={column.name}
                  column={column}
                  pixels={() => pixelsOf(column.name)}
                  pressed={column.name === large}
                  choose={() => (wanted.value = column.name)}
                />
              ))}
            </div>
          )}
          <Values />
        </div>
      </div>
      <Legend kinds={kinds} />
      <FrameSlider />
    </div>
  );
}

function read() {
  const all = pictures();
  return {
    all,
    large: largeName(all),
    kinds: markKinds(program.value, columns.value),
    empty: nothingToSee(),
  };
}

function labelOf(large: string | null): string {
  const frame = shown.value;
  if (large === null) return "no picture";
  if (frame < 0) return large === INPUT ? "the first frame that the chip will see" : large;
  const kinds = markKinds(program.value, columns.value);
  const marks = marksOf(batches.value, frame, kinds, clip.value);
  return `${large}, ${describe(frame, marks, kinds)}`;
}

function nothingToSee(): string {
  if (!program.value) return "The picture appears here once the program runs.";
  if (shown.value < 0) return "Press Run: the frames and what the program sends appear here.";
  return "This program gets no frames and sends no picture.";
}
