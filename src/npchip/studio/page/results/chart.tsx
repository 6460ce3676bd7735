/** A line chart of a number over the frames. */

import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { act } from "../actions";
import { batches, frameCount, program } from "../store";
import { firstFrame } from "./frames";
import { CYCLES, type Summary, bins, summarise } from "./series";
import { columns, shown, useSlowly } from "./shown";
import { useThemeChanges } from "./theme";

const chosen = signal(CYCLES);

function names(): string[] {
  const numbers = columns.value.filter(({ kind }) => kind === "scalar" || kind === "scalar16");
  return [CYCLES, ...numbers.map((column) => column.name)];
}

function read() {
  const all = names();
  const name = all.includes(chosen.value) ? chosen.value : CYCLES;
  const first = firstFrame(batches.value);
  return {
    all,
    name,
    first,
    frames: frameCount.value - first,
    shown: shown.value,
    summary: summarise(batches.value, name),
    limit: name === CYCLES ? (program.value?.budgets.cycles ?? null) : null,
    batches: batches.value,
  };
}

type Reading = ReturnType<typeof read>;

/** The chart; a click shows the frame at that place. */
export function Chart(): JSX.Element {
  const reading = useSlowly(read, 200);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [size, setSize] = useState(0);
  const theme = useThemeChanges();
  useEffect(() => {
    if (!canvas.current) return undefined;
    const observer = new ResizeObserver(([entry]) => setSize(entry?.contentRect.width ?? 0));
    observer.observe(canvas.current);
    return () => observer.disconnect();
  }, []);
  useEffect(() => {
    if (canvas.current && size) draw(canvas.current, reading);
  }, [reading, size, theme]);
  const { all, name, first, frames, summary } = reading;
  return (
    <div class="results-chart">
      <div class="results-bar">
        <label>
          Chart of{" "}
          <select
            value={name}
            onChange={(event) => {
              chosen.value = event.currentTarget.value;
            }}
          >
            {all.map((each) => (
              <option key={each} value={each}>
                {each}
              </option>
            ))}
          </select>
        </label>
        <span class="results-note">{summary ? inWords(summary) : "no number yet"}</span>
      </div>
      <canvas
        ref={canvas}
        role="img"
        aria-label={`${name} over the frames${summary ? `: ${inWords(summary)}` : ""}`}
        onClick={(event) => {
          if (!frames) return;
          const part = event.offsetX / event.currentTarget.clientWidth;
          act().showFrame(first + Math.min(frames - 1, Math.floor(part * frames)));
        }}
      />
    </div>
  );
}

/** Say the extremes and the newest number of a series. */
function inWords({ least, leastAt, most, mostAt, newest }: Summary): string {
  const text = (number: number): string => number.toLocaleString("en");
  if (least === most) return `${text(least)} in every frame`;
  const low = `minimum ${text(least)} (frame ${text(leastAt)})`;
  return `${low}, maximum ${text(most)} (frame ${text(mostAt)}), latest ${text(newest)}`;
}

function draw(canvas: HTMLCanvasElement, reading: Reading): void {
  const context = canvas.getContext("2d");
  if (!context) return;
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  context.scale(ratio, ratio);
  const { summary, frames, limit, name, first } = reading;
  if (!summary || !frames) return;
  const style = getComputedStyle(canvas);
  const colour = (property: string): string => style.getPropertyValue(property);
  const low = Math.min(0, summary.least);
  const high = Math.max(summary.most, limit ?? 0, low + 1);
  const y = (value: number): number => height - 4 - ((value - low) / (high - low)) * (height - 20);

  context.fillStyle = colour("--muted");
  context.strokeStyle = colour("--line");
  context.font = `11px ${style.fontFamily}`;
  context.fillText(high.toLocaleString("en"), 2, 10);
  horizontal(context, y(low), width, []);
  if (limit !== null) {
    context.strokeStyle = colour("--warn");
    horizontal(context, y(limit), width, [6, 4]);
    const text = "budget";
    context.fillText(text, width - context.measureText(text).width - 2, y(limit) - 3);
  }

  const marker = ((reading.shown - first + 0.5) * width) / frames;
  context.strokeStyle = colour("--muted");
  context.lineWidth = 1;
  context.setLineDash([2, 2]);
  context.beginPath();
  context.moveTo(marker, 12);
  context.lineTo(marker, height);
  context.stroke();
  context.setLineDash([]);

  const count = Math.max(1, Math.min(frames, Math.floor(width)));
  const parts = bins(reading.batches, name, frames, count);
  context.strokeStyle = colour("--accent");
  context.lineWidth = 1.5;
  context.lineJoin = "round";
  context.beginPath();
  let joined = false;
  for (let at = 0; at < count; at++) {
    const [least, most] = [parts.low[at] as number, parts.high[at] as number];
    if (Number.isNaN(least)) {
      joined = false;
      continue;
    }
    const x = ((at + 0.5) * width) / count;
    if (joined) context.lineTo(x, y(most));
    else context.moveTo(x, y(most));
    context.lineTo(x, y(least) + (least === most ? 0.01 : 0)); // a lone frame is a dot
    joined = true;
  }
  context.lineCap = "round";
  context.stroke();
}

function horizontal(
  context: CanvasRenderingContext2D,
  y: number,
  width: number,
  dash: number[],
): void {
  context.setLineDash(dash);
  context.beginPath();
  context.moveTo(0, y);
  context.lineTo(width, y);
  context.stroke();
  context.setLineDash([]);
}
