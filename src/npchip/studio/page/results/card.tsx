/** A small picture: an output of the frame that is shown, with its name and range of numbers. */

import { effect } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { batches, clip } from "../store";
import { type Column, rangeOf } from "./frames";
import { Grey } from "./paint";
import { INPUT } from "./scene";
import { shown, useSlowly } from "./shown";

interface Props {
  column: Column;
  /** Reads the pixels of the frame that is shown; null if there are none. */
  pixels: () => Uint8Array | null;
  pressed: boolean;
  choose: () => void;
}

/** A button that shows its picture large. */
export function PictureCard({ column, pixels, pressed, choose }: Props): JSX.Element {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { name, rows, cols } = column;
  useEffect(() => {
    if (!canvas.current || !rows) return undefined;
    const grey = new Grey(canvas.current);
    const none = new Uint8Array(rows * cols);
    let request = 0;
    const paint = (): void => {
      request = 0;
      const [low, high] = shades(column);
      grey.set(pixels() ?? none, rows, cols, low, high);
    };
    const dispose = effect(() => {
      void [batches.value, shown.value, clip.value];
      if (!request) request = requestAnimationFrame(paint);
    });
    return () => {
      dispose();
      cancelAnimationFrame(request);
    };
  }, [name, rows, cols]);
  const note = useSlowly(() => span(column, pixels() !== null), 250, [name, rows, cols]);
  return (
    <button type="button" class="results-card" aria-pressed={pressed} onClick={choose}>
      <canvas ref={canvas} aria-hidden="true" />
      <span class="results-card-name">{name}</span>
      <span class="results-card-note">{note}</span>
    </button>
  );
}

/** Return what is drawn black and white, large and small: outputs use the run's range, as `--render` does. */
export function shades(column: Column): [number, number] {
  const range = column.name === INPUT ? null : rangeOf(batches.value, column.name);
  return range && range[0] < range[1] ? range : [0, 255];
}

function span(column: Column, sent: boolean): string {
  const size = column.rows ? `${column.rows} × ${column.cols}` : column.kind;
  if (!sent) return `${size}, nothing sent`;
  if (column.name === INPUT) return size;
  const range = rangeOf(batches.value, column.name);
  if (!range) return size;
  const [low, high] = range;
  return low < high ? `${size}, black ${low}, white ${high}` : `${size}, ${low} everywhere`;
}
