/** The field of NPs: shades on a canvas, above them cells with numbers, above them arrows. */

import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import { act } from "../actions";
import type { ChipView } from "../protocol";
import { chosen, program } from "../store";
import { Arrows } from "./Arrows";
import { format, inkOn, shade } from "./format";
import { moved } from "./keys";
import { shownText } from "./names";
import { paint } from "./paint";
import { SIDE, changes, pictureChanges, pictureOf, planeOf } from "./planes";
import { base, passing, reference, shown } from "./state";

/** Above this, NPs are too small for numbers, and too many to be elements of their own. */
const MOST_CELLS = 400;

interface Props {
  view: ChipView;
  rows: number;
  cols: number;
}

/** Everything that is shown of the NPs at a moment. */
interface Look {
  values: Uint8Array | null;
  picture: Uint8Array | null;
  shades: number[];
  changed: boolean[];
  inactive: boolean[];
}

function lookAt({ view, rows, cols }: Props): Look {
  const old = reference.value;
  const inactive = Array.from(view.active, (on) => !on);
  const what = shown.value;
  const picture = pictureOf(view, what, rows, cols);
  if (picture || what.kind !== "cell") {
    const was = old && pictureOf(old, what, rows, cols);
    const changed = picture ? pictureChanges(picture, was, rows, cols) : [];
    return { values: null, picture, shades: [], changed, inactive };
  }
  const { cell } = what;
  const values = planeOf(view, cell);
  const oneBit = cell.kind === "flag" || cell.kind === "active";
  const shades = Array.from(values, (value) => (oneBit ? value * 255 : shade(value, base.value)));
  return { values, picture, shades, changed: changes(values, old && planeOf(old, cell)), inactive };
}

/** The array of an 8 × 10 machine with numbers, or of a larger one without. */
export function Field({ view, rows, cols }: Props): JSX.Element {
  const look = lookAt({ view, rows, cols });
  const many = rows * cols > MOST_CELLS;
  const canvas = useRef<HTMLCanvasElement>(null);
  useLayoutEffect(() => {
    const marks = many ? look : null;
    const pixels = paint({ rows, cols, picture: look.picture, shades: look.shades, marks });
    const image = new ImageData(pixels, cols * SIDE, rows * SIDE);
    canvas.current?.getContext("2d")?.putImageData(image, 0, 0);
  });
  return (
    <div class="array-stage">
      <div class="array-frame" style={{ "--rows": rows, "--cols": cols }}>
        <Numbers count={cols} along="column" />
        <Numbers count={rows} along="row" />
        <div class={`array-field${many ? " array-many" : ""}${cols > 14 ? " array-wide" : ""}`}>
          <canvas ref={canvas} width={cols * SIDE} height={rows * SIDE} aria-hidden="true" />
          <Grid look={look} rows={rows} cols={cols} many={many} />
          {passing.value && <Arrows passing={passing.value} view={view} rows={rows} cols={cols} />}
        </div>
      </div>
    </div>
  );
}

/** Numbers of the columns or rows along an edge; screen readers find them in the cells. */
function Numbers({ count, along }: { count: number; along: "row" | "column" }): JSX.Element {
  const every = count > 30 ? 10 : 1;
  const all = Array.from({ length: count }, (_, at) => (at % every ? "" : at));
  return (
    <div class={`array-numbers array-${along}s`} aria-hidden="true">
      {all.map((text, at) => (
        <span key={at}>{text}</span>
      ))}
    </div>
  );
}

function Grid({ look, rows, cols, many }: { look: Look; rows: number; cols: number; many: boolean }): JSX.Element {
  const grid = useRef<HTMLDivElement>(null);
  const spot = useSignal(chosen.peek());
  const follow = useRef(false);
  const { row, column } = chosen.value;
  useEffect(() => {
    spot.value = { row, column };
  }, [row, column]);
  const at = {
    row: Math.min(spot.value.row, rows - 1),
    column: Math.min(spot.value.column, cols - 1),
  };
  useLayoutEffect(() => {
    if (follow.current) grid.current?.querySelector<HTMLElement>('[tabindex="0"]')?.focus();
    follow.current = false;
  }, [at.row, at.column]);

  const press = (event: KeyboardEvent): void => {
    if (event.altKey || event.metaKey) return;
    const to = moved(event.key, event.ctrlKey, at.row, at.column, rows, cols);
    if (to) {
      follow.current = true;
      spot.value = to;
    } else if (event.key === "Enter" || event.key === " ") act().choose(at.row, at.column);
    else return;
    event.preventDefault();
  };
  const click = (event: MouseEvent): void => {
    const hit = placeOf(event, grid.current, rows, cols);
    if (!hit) return;
    spot.value = hit;
    act().choose(hit.row, hit.column);
  };

  // A large array has the element of one NP only, the one with the focus.
  const shownRows = many ? [at.row] : [...Array(rows).keys()];
  const shownCols = many ? [at.column] : [...Array(cols).keys()];
  return (
    <div
      ref={grid}
      class="array-grid"
      role="grid"
      aria-label={`NPs: ${shownText(program.value, shown.value)}`}
      aria-rowcount={rows}
      aria-colcount={cols}
      onKeyDown={press}
      onClick={click}
    >
      {shownRows.map((r) => (
        <div key={many ? "row" : r} role="row" class="array-row" aria-rowindex={r + 1}>
          {shownCols.map((c) => (
            <NP
              key={many ? "np" : c}
              look={look}
              row={r}
              column={c}
              cols={cols}
              focus={r === at.row && c === at.column}
              written={!many}
            />
          ))}
        </div>
      ))}
      {many && <Frame row={row} column={column} />}
    </div>
  );
}

interface NPProps {
  look: Look;
  row: number;
  column: number;
  cols: number;
  focus: boolean;
  /** True if there is room for the number. */
  written: boolean;
}

function NP({ look, row, column, cols, focus, written }: NPProps): JSX.Element {
  const at = row * cols + column;
  const picked = chosen.value.row === row && chosen.value.column === column;
  const value = look.values?.[at];
  const text = value === undefined ? "" : format(value, base.value);
  const marks: [boolean | undefined, string][] = [
    [look.inactive[at], "inactive"],
    [look.changed[at], "changed"],
    [picked, "chosen"],
  ];
  const held = marks.filter(([on]) => on).map(([, name]) => name);
  const said = [`NP ${row}, ${column}${text ? `: ${text}` : ""}`, ...held].join(", ");
  return (
    <div
      role="gridcell"
      class={["array-np", ...held.map((name) => `array-${name}`)].join(" ")}
      aria-colindex={column + 1}
      aria-label={said}
      aria-selected={picked}
      tabIndex={focus ? 0 : -1}
      data-row={row}
      data-column={column}
      style={{ "--row": row, "--column": column, color: inkOn(look.shades[at] ?? 0) }}
    >
      {written && text && <span>{text}</span>}
    </div>
  );
}

/** The frame around the chosen NP of a large array. */
function Frame({ row, column }: { row: number; column: number }): JSX.Element {
  return <div class="array-np array-chosen" aria-hidden="true" style={{ "--row": row, "--column": column }} />;
}

/** The NP that a click means: that of the element, or the one at the place. */
function placeOf(
  event: MouseEvent,
  grid: HTMLElement | null,
  rows: number,
  cols: number,
): { row: number; column: number } | null {
  const cell = (event.target as Element).closest<HTMLElement>("[data-row]");
  if (cell) return { row: Number(cell.dataset.row), column: Number(cell.dataset.column) };
  if (!grid) return null;
  const box = grid.getBoundingClientRect();
  const row = Math.floor(((event.clientY - box.top) / box.height) * rows);
  const column = Math.floor(((event.clientX - box.left) / box.width) * cols);
  return row >= 0 && row < rows && column >= 0 && column < cols ? { row, column } : null;
}
