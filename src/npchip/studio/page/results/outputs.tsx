/** The table of all frames with their outputs and cycles. */

import type { JSX } from "preact";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import { act } from "../actions";
import { batches, frameCount, program, running, view } from "../store";
import { OutputRow } from "./row";
import {
  type Column,
  SETUP,
  endFrame,
  firstFrame,
  firstWithImages,
  isImage,
  setupOf,
} from "./frames";
import { ROW_HEIGHT, rowAfterKey, visibleRows } from "./rows";
import { toCsv, toJson } from "./save";
import { columns, shown, useSlowly } from "./shown";

/** The table `Outputs` and the buttons that save it. */
export function Outputs(): JSX.Element {
  const run = useSlowly(read, 100);
  return (
    <div class="results-outputs">
      <Table run={run} />
      <div class="results-bar">
        <button type="button" onClick={saveCsv}>
          Save as CSV
        </button>
        <button type="button" onClick={saveJson}>
          Save as JSON
        </button>
        <span class="results-note">{notes(run)}</span>
      </div>
    </div>
  );
}

interface Run {
  batches: ReturnType<typeof batches.peek>;
  columns: Column[];
  shown: number;
}

function read(): Run {
  return { batches: batches.value, columns: columns.value, shown: shown.value };
}

/** Rows that are drawn, whether the newest row is followed, and where the keyboard is. */
function Table({ run }: { run: Run }): JSX.Element {
  const scroller = useRef<HTMLDivElement>(null);
  const [scroll, setScroll] = useState({ top: 0, height: 400 });
  const [follows, setFollows] = useState(true);
  const [current, setCurrent] = useState<number | null>(null);
  const lastTop = useRef(0);
  const moved = useRef(false);

  const first = firstFrame(run.batches);
  const lead = setupOf(run.batches) ? 1 : 0;
  const frames = endFrame(run.batches) - first;
  const count = lead + frames;
  const frameOf = (row: number): number => (row < lead ? SETUP : first + row - lead);
  const rowOf = (frame: number): number => (frame < 0 ? 0 : frame - first + lead);
  const { start, end, above } = visibleRows(count, scroll.top, scroll.height);
  const tabRow = Math.min(count - 1, Math.max(0, current ?? rowOf(run.shown)));

  useEffect(() => {
    const box = scroller.current;
    if (!box) return undefined;
    const observer = new ResizeObserver(() =>
      setScroll((old) => ({ ...old, height: box.clientHeight })),
    );
    observer.observe(box);
    return () => observer.disconnect();
  }, []);

  useLayoutEffect(() => {
    const box = scroller.current;
    if (!box || !follows) return;
    box.scrollTop = box.scrollHeight;
    lastTop.current = box.scrollTop;
    setScroll((old) => (old.top === box.scrollTop ? old : { ...old, top: box.scrollTop }));
  }, [count, follows, scroll.height]);

  useLayoutEffect(() => {
    if (!moved.current) return;
    moved.current = false;
    scroller.current
      ?.querySelector<HTMLButtonElement>(`[data-row="${tabRow}"]`)
      ?.focus({ preventScroll: true });
  }, [tabRow, start]);

  const onScroll = (): void => {
    const box = scroller.current;
    if (!box) return;
    const atEnd = box.scrollTop + box.clientHeight >= box.scrollHeight - ROW_HEIGHT;
    if (atEnd) setFollows(true);
    else if (box.scrollTop < lastTop.current - 2) setFollows(false);
    lastTop.current = box.scrollTop;
    setScroll((old) => ({ ...old, top: box.scrollTop }));
  };

  const onKeyDown = (event: KeyboardEvent): void => {
    const box = scroller.current;
    if (!box || !(event.target instanceof HTMLButtonElement)) return;
    const to = rowAfterKey(event.key, tabRow, count, box.clientHeight);
    if (to === null) return;
    event.preventDefault();
    moved.current = true;
    setCurrent(to);
    setFollows(to === count - 1);
    const top = to * ROW_HEIGHT;
    const room = box.clientHeight - 2 * ROW_HEIGHT; // without the head
    if (top < box.scrollTop) box.scrollTop = top;
    else if (top > box.scrollTop + room) box.scrollTop = top - room;
    lastTop.current = box.scrollTop;
    setScroll((old) => ({ ...old, top: box.scrollTop }));
  };

  const show = (row: number): void => {
    setCurrent(row);
    const frame = frameOf(row);
    if (frame !== SETUP) act().showFrame(frame === first + frames - 1 ? null : frame);
  };

  const rows: JSX.Element[] = [];
  for (let row = start; row < end; row++) {
    const frame = frameOf(row);
    rows.push(
      <OutputRow
        key={frame}
        row={row}
        frame={frame}
        columns={run.columns}
        batches={run.batches}
        isShown={frame === run.shown}
        tabbable={row === tabRow}
        show={show}
      />,
    );
  }
  return (
    <div class="results-table-box">
      <div
        class="results-scroller"
        ref={scroller}
        onScroll={onScroll}
        onKeyDown={onKeyDown}
        role="group"
        aria-label="Frames, scrollable"
        tabIndex={0}
      >
        <div style={{ height: `${(count + 1) * ROW_HEIGHT}px` }}>
          <div style={{ height: `${above}px` }} />
          <table aria-label="Outputs" aria-rowcount={count + 1} class="results-table">
            <thead>
              <tr aria-rowindex={1}>
                <th scope="col" class="results-col-frame">
                  frame
                </th>
                {run.columns.map((column) => (
                  <th scope="col" key={column.name} class={`results-col-${column.kind}`}>
                    {column.name}
                  </th>
                ))}
                <th scope="col" class="results-col-cycles">
                  cycles
                </th>
              </tr>
            </thead>
            <tbody>{rows}</tbody>
          </table>
        </div>
      </div>
      {count === 0 && <p class="results-empty">No frame yet. Press Run to see what each one sends.</p>}
      {!follows && running.value && (
        <button type="button" class="results-follow" onClick={() => setFollows(true)}>
          Follow newest ↓
        </button>
      )}
    </div>
  );
}

/** Say what is not in the table or will not be in a saved file. */
function notes(run: Run): string {
  const said: string[] = [];
  const images = run.columns.filter(isImage).map((column) => column.name);
  if (images.length) said.push(`The CSV leaves out ${images.join(", ")}.`);
  const first = firstFrame(run.batches);
  if (first > 0) said.push(`Frames before ${first.toLocaleString("en")} are no longer kept.`);
  const whole = firstWithImages(run.batches);
  if (images.length && whole > first) {
    said.push(`Planes and pictures before frame ${whole.toLocaleString("en")} are no longer kept.`);
  }
  return said.join(" ");
}

function baseName(): string {
  return (program.peek()?.name ?? "run").replace(/[^\w.-]/g, "_");
}

function saveCsv(): void {
  act().save(`${baseName()}.csv`, toCsv(program.peek(), batches.peek()), "text/csv");
}

function saveJson(): void {
  const now = program.peek();
  if (!now || (frameCount.peek() === 0 && !setupOf(batches.peek()))) return;
  const parts = toJson(now, batches.peek(), view.peek());
  act().save(`${baseName()}.json`, new Blob(parts), "application/json");
}
