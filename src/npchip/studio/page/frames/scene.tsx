/** An editor for drawn scenes: paint grey pixels, give them a motion, take the frames as a clip. */

import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import type { Clip } from "../protocol";
import { type Drawing, drawnClip, drawnFrame, MOST_BRUSH, MOST_FRAMES, painted, type Stroke } from "./draw";
import type { Size } from "./errors";

export interface SceneEditorProps {
  /** The sensor's size. */
  size: Size;
  /** The drawing to go on with; null for an empty canvas. */
  before: Drawing | null;
  /** Given the drawing after each change. */
  onChange(drawing: Drawing): void;
  /** The reader wants the drawing as the clip. */
  onUse(): void;
  /** The reader wants to save the frames. */
  onSave(clip: Clip): void;
}

/** Milliseconds between the frames of the preview. */
const STEP = 66;

/** The editor. */
export function SceneEditor({ size, before, onChange, onUse, onSave }: SceneEditorProps): JSX.Element {
  const strokes = useSignal<Stroke[]>(before?.strokes ?? []);
  /** The strokes before each change, which Undo brings back. */
  const past = useSignal<Stroke[][]>([]);
  const brush = useSignal(6);
  const grey = useSignal(230);
  const rubbing = useSignal(false);
  const background = useSignal(before?.background ?? 30);
  const down = useSignal(before?.motion.rows ?? 0);
  const right = useSignal(before?.motion.cols ?? 1);
  const frames = useSignal(before?.frames ?? 30);
  const drawing: Drawing = {
    ...size,
    background: background.value,
    strokes: strokes.value,
    motion: { rows: down.value, cols: right.value },
    frames: frames.value,
  };
  const first = useRef(true);
  useEffect(() => {
    if (!first.current) onChange(drawing); // what is there at first is known
    first.current = false;
  }, [strokes.value, background.value, down.value, right.value, frames.value]);
  const change = (now: Stroke[]): void => {
    past.value = [...past.value, strokes.value];
    strokes.value = now;
  };
  const begin = (row: number, col: number): void => {
    const value = rubbing.value ? null : grey.value;
    change([...strokes.value, { points: [{ row, col }], brush: brush.value, grey: value }]);
  };
  const extend = (row: number, col: number): void => {
    const last = strokes.value.at(-1);
    if (!last) return;
    const points = [...last.points, { row, col }];
    strokes.value = [...strokes.value.slice(0, -1), { ...last, points }];
  };
  return (
    <section class="frames-scene" aria-label="Drawn scene">
      <Sheet drawing={drawing} begin={begin} extend={extend} />
      <div class="frames-controls">
        <NumberField label="Brush size" unit="pixels" least={1} most={MOST_BRUSH} value={brush} />
        <NumberField label="Grey" unit="0 to 255" least={0} most={255} value={grey} />
        <label class="frames-check">
          <input
            type="checkbox"
            checked={rubbing.value}
            onChange={(event) => {
              rubbing.value = event.currentTarget.checked;
            }}
          />
          Erase
        </label>
        <NumberField label="Background" unit="0 to 255" least={0} most={255} value={background} />
        <NumberField label="Down" unit="pixels a frame" least={-20} most={20} step={0.25} value={down} />
        <NumberField label="Right" unit="pixels a frame" least={-20} most={20} step={0.25} value={right} />
        <NumberField label="Frames" unit={`1 to ${MOST_FRAMES}`} least={1} most={MOST_FRAMES} value={frames} />
      </div>
      <Preview drawing={drawing} />
      <div class="frames-buttons">
        <button
          type="button"
          disabled={past.value.length === 0}
          onClick={() => {
            strokes.value = past.value.at(-1) ?? [];
            past.value = past.value.slice(0, -1);
          }}
        >
          Undo
        </button>
        <button
          type="button"
          disabled={strokes.value.length === 0}
          onClick={() => change([])}
        >
          Clear drawing
        </button>
        <button type="button" onClick={() => onSave(drawnClip(drawing))}>
          Save as .npy
        </button>
        <button
          type="button"
          class="frames-main"
          onClick={() => {
            onChange(drawing);
            onUse();
          }}
        >
          Use this scene
        </button>
      </div>
    </section>
  );
}

interface NumberFieldProps {
  label: string;
  unit: string;
  least: number;
  most: number;
  step?: number;
  value: { value: number };
}

/** A number with its limits; one outside of them is taken as the nearest. */
function NumberField({ label, unit, least, most, step = 1, value }: NumberFieldProps): JSX.Element {
  return (
    <label class="frames-field">
      <span>
        {label} <small>{unit}</small>
      </span>
      <input
        type="number"
        min={least}
        max={most}
        step={step}
        value={value.value}
        onChange={(event) => {
          const typed = event.currentTarget.valueAsNumber;
          const whole = Number.isInteger(step) ? Math.round(typed) : typed;
          if (Number.isFinite(typed)) value.value = Math.min(most, Math.max(least, whole));
          event.currentTarget.value = String(value.value);
        }}
      />
    </label>
  );
}

interface SheetProps {
  drawing: Drawing;
  begin(row: number, col: number): void;
  extend(row: number, col: number): void;
}

/** The sheet to paint on: by pointer, or by arrow keys that move a brush and Space that puts it down. */
function Sheet({ drawing, begin, extend }: SheetProps): JSX.Element {
  const { rows, cols } = drawing;
  const canvas = useRef<HTMLCanvasElement>(null);
  const place = useSignal({ row: rows >> 1, col: cols >> 1 });
  const focused = useSignal(false);
  const pressed = useRef(false);
  const at = useRef(place.value);
  useEffect(() => {
    const marked = focused.value ? place.value : null;
    show(canvas.current, drawing, drawnFrame(painted(drawing), drawing, 0), marked);
  });
  const pixel = (event: PointerEvent): { row: number; col: number } => {
    const box = canvas.current!.getBoundingClientRect();
    const row = Math.floor(((event.clientY - box.top) * rows) / box.height);
    const col = Math.floor(((event.clientX - box.left) * cols) / box.width);
    return { row, col };
  };
  const move = (event: PointerEvent): void => {
    if (!pressed.current) return;
    const next = pixel(event);
    if (next.row === at.current.row && next.col === at.current.col) return;
    at.current = next;
    extend(next.row, next.col);
  };
  const key = (event: KeyboardEvent): void => {
    const ways: Record<string, [number, number]> = {
      ArrowUp: [-1, 0],
      ArrowDown: [1, 0],
      ArrowLeft: [0, -1],
      ArrowRight: [0, 1],
    };
    const way = ways[event.key];
    const { row, col } = place.value;
    if (event.key === " " || event.key === "Enter") begin(row, col);
    else if (way) {
      const far = event.ctrlKey ? 8 : 1;
      const next = {
        row: Math.min(rows - 1, Math.max(0, row + way[0] * far)),
        col: Math.min(cols - 1, Math.max(0, col + way[1] * far)),
      };
      if (event.shiftKey) {
        begin(row, col);
        extend(next.row, next.col);
      }
      place.value = next;
    } else return;
    event.preventDefault();
  };
  return (
    <div class="frames-sheet">
      <canvas
        ref={canvas}
        width={cols}
        height={rows}
        tabIndex={0}
        role="application"
        aria-label={`Canvas, ${rows} × ${cols} pixels`}
        aria-describedby="frames-keys"
        onPointerDown={(event) => {
          if (event.button !== 0) return;
          event.currentTarget.setPointerCapture(event.pointerId);
          pressed.current = true;
          at.current = pixel(event);
          begin(at.current.row, at.current.col);
        }}
        onPointerMove={move}
        onPointerUp={() => {
          pressed.current = false;
        }}
        onPointerCancel={() => {
          pressed.current = false;
        }}
        onKeyDown={key}
        onFocus={() => {
          focused.value = true;
        }}
        onBlur={() => {
          focused.value = false;
        }}
      />
      <p id="frames-keys">
        Paint with the pointer. Keys: arrows move the brush (Ctrl: by 8 pixels), Space paints, Shift
        with an arrow draws a line.
      </p>
      <p class="frames-place" role="status">
        {focused.value ? `Row ${place.value.row}, column ${place.value.col}` : ""}
      </p>
    </div>
  );
}

/** The scene in motion; it stands still where the reader asks for no motion. */
function Preview({ drawing }: { drawing: Drawing }): JSX.Element {
  const { rows, cols, frames } = drawing;
  const canvas = useRef<HTMLCanvasElement>(null);
  const index = useSignal(0);
  const moving = useSignal(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  const shown = Math.min(index.value, frames - 1);
  useEffect(() => {
    show(canvas.current, drawing, drawnFrame(painted(drawing), drawing, shown), null);
  });
  useEffect(() => {
    if (!moving.value) return undefined;
    const timer = setInterval(() => {
      index.value = index.value + 1 < frames ? index.value + 1 : 0;
    }, STEP);
    return () => clearInterval(timer);
  }, [moving.value, frames]);
  return (
    <div class="frames-preview">
      <canvas ref={canvas} width={cols} height={rows} role="img" aria-label="Preview of the scene" />
      <label class="frames-field">
        <span>
          Preview, frame {shown + 1} of {frames}
        </span>
        <input
          type="range"
          min={0}
          max={frames - 1}
          value={shown}
          onInput={(event) => {
            moving.value = false;
            index.value = event.currentTarget.valueAsNumber;
          }}
        />
      </label>
      <button
        type="button"
        onClick={() => {
          moving.value = !moving.value;
        }}
      >
        {moving.value ? "Pause preview" : "Play preview"}
      </button>
    </div>
  );
}

/** Put greys on a canvas, and a mark of contrasting corners where the brush stands. */
function show(
  canvas: HTMLCanvasElement | null,
  { rows, cols }: Size,
  greys: Uint8Array,
  mark: { row: number; col: number } | null,
): void {
  const context = canvas?.getContext("2d");
  if (!context) return;
  const image = context.createImageData(cols, rows);
  for (let at = 0; at < greys.length; at++) {
    image.data.fill(greys[at]!, 4 * at, 4 * at + 3);
    image.data[4 * at + 3] = 255;
  }
  if (mark) {
    for (const [y, x] of [[-2, 0], [2, 0], [0, -2], [0, 2]] as const) {
      const [row, col] = [mark.row + y, mark.col + x];
      if (row < 0 || row >= rows || col < 0 || col >= cols) continue;
      const at = row * cols + col;
      image.data.fill(greys[at]! < 128 ? 255 : 0, 4 * at, 4 * at + 3);
    }
  }
  context.putImageData(image, 0, 0);
}
