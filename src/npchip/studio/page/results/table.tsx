/** The table of frames: only the rows around the visible ones are drawn. */

import type { JSX } from "preact";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import { act } from "../actions";
import type { FrameBatch } from "../protocol";
import { running } from "../store";
import { type Column, SETUP, endFrame, firstFrame, setupOf } from "./frames";
import { OutputRow } from "./row";
import { ROW_HEIGHT, rowAfterKey, visibleRows } from "./rows";

/** Characters that a column's content has room for; longer ones are cut. */
const ROOM = { frame: 9, scalar: 3, scalar16: 6, list: 30, plane: 14, picture: 14, cycles: 10 };

/** Contents of the table. */
export interface Run {
  batches: FrameBatch[];
  columns: Column[];
  /** Index of the frame that the pictures show. */
  shown: number;
  /** True if the reader chose it, false if it is the newest. */
  pinned: boolean;
}

/** Scrolling of the table: it follows the newest row unless the reader scrolled. */
function useScroll(count: number, pinnedRow: number | null) {
  const box = useRef<HTMLDivElement>(null);
  const [scroll, setScroll] = useState({ top: 0, height: 400 });
  const [follows, setFollows] = useState(true);
  const lastTop = useRef(0);

  const note = (): void => {
    const now = box.current;
    if (!now) return;
    lastTop.current = now.scrollTop;
    setScroll({ top: now.scrollTop, height: now.clientHeight });
  };

  const reveal = (row: number): void => {
    const now = box.current;
    if (!now) return;
    const top = row * ROW_HEIGHT;
    const room = now.clientHeight - 2 * ROW_HEIGHT; // without the head and the row itself
    if (top < now.scrollTop) now.scrollTop = top;
    else if (top > now.scrollTop + room) now.scrollTop = top - room;
    note();
  };

  const onScroll = (): void => {
    const now = box.current;
    if (!now) return;
    const atEnd = now.scrollTop + now.clientHeight >= now.scrollHeight - ROW_HEIGHT;
    if (atEnd) setFollows(true);
    else if (now.scrollTop < lastTop.current - 2) setFollows(false);
    // The position of a table that follows is known before it is drawn.
    if (atEnd && follows) lastTop.current = now.scrollTop;
    else note();
  };

  useEffect(() => {
    const now = box.current;
    if (!now) return undefined;
    const observer = new ResizeObserver(note);
    observer.observe(now);
    return () => observer.disconnect();
  }, []);

  useLayoutEffect(() => {
    setFollows(pinnedRow === null);
    if (pinnedRow !== null) reveal(pinnedRow);
  }, [pinnedRow]);

  useLayoutEffect(() => {
    if (!box.current || !follows || pinnedRow !== null) return;
    box.current.scrollTop = (count + 1) * ROW_HEIGHT;
  }, [count, follows, scroll.height]);

  const top = follows && pinnedRow === null ? (count + 1) * ROW_HEIGHT - scroll.height : scroll.top;
  return { box, top, height: scroll.height, follows, setFollows, reveal, onScroll };
}

/** Return the widths of a table's columns, which depend on no row: only some are drawn. */
function widthsOf(columns: readonly Column[]): string[] {
  const rooms = columns.map(({ name, kind }) => Math.max(name.length, ROOM[kind]));
  return [ROOM.frame, ...rooms, ROOM.cycles].map((room) => `calc(${room}ch + 1rem)`);
}

/** The table `Outputs`: arrow keys go through its rows, Enter shows the frame of one. */
export function Table({ run }: { run: Run }): JSX.Element {
  const first = firstFrame(run.batches);
  const lead = setupOf(run.batches) ? 1 : 0;
  const frames = endFrame(run.batches) - first;
  const count = lead + frames;
  const frameOf = (row: number): number => (row < lead ? SETUP : first + row - lead);
  const rowOf = (frame: number): number => (frame < 0 ? 0 : frame - first + lead);

  const pinnedRow = run.pinned ? rowOf(run.shown) : null;
  const { box, top, height, follows, setFollows, reveal, onScroll } = useScroll(count, pinnedRow);
  const { start, end, above } = visibleRows(count, top, height, running.value);

  // The frame whose row the tab key reaches; null for the one that is shown.
  const [current, setCurrent] = useState<number | null>(null);
  const tabRow = Math.min(count - 1, Math.max(0, rowOf(current ?? run.shown)));
  const moved = useRef(false);

  useEffect(() => setCurrent(null), [pinnedRow]);

  useLayoutEffect(() => {
    if (!moved.current) return;
    moved.current = false;
    box.current
      ?.querySelector<HTMLButtonElement>(`[data-row="${tabRow}"]`)
      ?.focus({ preventScroll: true });
  }, [tabRow, start]);

  const onKeyDown = (event: KeyboardEvent): void => {
    if (!(event.target instanceof HTMLButtonElement)) return;
    const to = rowAfterKey(event.key, tabRow, count, height);
    if (to === null) return;
    event.preventDefault();
    moved.current = true;
    setCurrent(frameOf(to));
    setFollows(to === count - 1);
    reveal(to);
  };

  const show = (row: number): void => {
    const frame = frameOf(row);
    setCurrent(frame);
    if (frame !== SETUP) act().showFrame(row === count - 1 ? null : frame);
  };

  const widths = widthsOf(run.columns);
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
        ref={box}
        onScroll={onScroll}
        onKeyDown={onKeyDown}
        role="group"
        aria-label="Frames, scrollable"
        tabIndex={0}
      >
        <div style={{ height: `${(count + 1) * ROW_HEIGHT}px` }}>
          <div style={{ height: `${above}px` }} />
          <table
            aria-label="Outputs"
            aria-rowcount={count + 1}
            class="results-table"
            style={{ minWidth: `calc(${widths.join(" + ")})` }}
          >
            <colgroup>
              {widths.map((width, index) => (
                <col key={index} style={{ width }} />
              ))}
            </colgroup>
            <thead>
              <tr aria-rowindex={1}>
                <th scope="col">frame</th>
                {run.columns.map((column) => (
                  <th scope="col" key={column.name} class={`results-col-${column.kind}`}>
                    {column.name}
                  </th>
                ))}
                <th scope="col">cycles</th>
              </tr>
            </thead>
            <tbody>{rows}</tbody>
          </table>
        </div>
      </div>
      {count === 0 && <p class="results-empty">No frame yet. Press Run to see what each one sends.</p>}
      {!follows && !run.pinned && running.value && (
        <button type="button" class="results-follow" onClick={() => setFollows(true)}>
          Follow newest ↓
        </button>
      )}
    </div>
  );
}
