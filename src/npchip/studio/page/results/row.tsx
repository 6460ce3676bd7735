/** A row of the table of outputs: a frame, or the setup. */

import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import type { FrameBatch } from "../protocol";
import { asText } from "./values";
import {
  type Column,
  SETUP,
  cyclesOf,
  extremes,
  isImage,
  rangeOf,
  sentIn,
  setupOf,
} from "./frames";
import { Grey } from "./paint";

interface Props {
  row: number;
  frame: number;
  columns: Column[];
  batches: FrameBatch[];
  isShown: boolean;
  /** True for the one row that the tab key reaches. */
  tabbable: boolean;
  show: (row: number) => void;
}

/** The row; its first cell holds a button that shows the frame. */
export function OutputRow(props: Props): JSX.Element {
  const { row, frame, columns, batches, isShown } = props;
  const cycles = frame === SETUP ? setupOf(batches)?.cycles : cyclesOf(batches, frame);
  return (
    <tr
      aria-rowindex={row + 2}
      aria-current={isShown ? "true" : undefined}
      onClick={() => props.show(row)}
    >
      <th scope="row">
        <button type="button" data-row={row} tabIndex={props.tabbable ? 0 : -1}>
          {frame === SETUP ? "setup" : frame}
        </button>
      </th>
      {columns.map((column) => {
        const value = sentIn(batches, column.name, frame);
        if (isImage(column)) {
          return (
            <td key={column.name} class="results-image">
              <Thumbnail column={column} value={value} batches={batches} />
            </td>
          );
        }
        const text = asText(value);
        return (
          <td
            key={column.name}
            class={`results-col-${column.kind}`}
            title={column.kind === "list" ? text : undefined}
          >
            {text}
          </td>
        );
      })}
      <td>{cycles?.toLocaleString("en") ?? "–"}</td>
    </tr>
  );
}

function Thumbnail(props: {
  column: Column;
  value: ReturnType<typeof sentIn>;
  batches: FrameBatch[];
}): JSX.Element {
  const { column, value, batches } = props;
  const canvas = useRef<HTMLCanvasElement>(null);
  const pixels = value instanceof Uint8Array ? value : null;
  useEffect(() => {
    if (!canvas.current || !pixels) return;
    const range = rangeOf(batches, column.name);
    const [low, high] = range && range[0] < range[1] ? range : [0, 255];
    new Grey(canvas.current).set(pixels, column.rows, column.cols, low, high);
  }, [pixels, column.rows, column.cols]);
  if (value === undefined) return <span class="results-muted">not kept</span>;
  if (!pixels) return <>–</>;
  const [low, high] = extremes(pixels);
  const size = `${column.rows} × ${column.cols}`;
  return (
    <>
      <canvas ref={canvas} role="img" aria-label={`${column.name}, ${low} to ${high}`} /> {size}
    </>
  );
}
