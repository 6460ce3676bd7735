/** The table of all frames with their outputs and cycles. */

import type { JSX } from "preact";
import { act } from "../actions";
import { batches, frameCount, program, shownFrame, view } from "../store";
import { firstFrame, firstWithImages, isImage, setupOf } from "./frames";
import { toCsv, toJson } from "./save";
import { columns, shown, useSlowly } from "./shown";
import { type Run, Table } from "./table";

/** The table `Outputs` and the buttons that save it. */
export function Outputs(): JSX.Element {
  const run = useSlowly(read, 100);
  const missing = useSlowly(brokenOff, 100);
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
        <span class="results-note">{[missing, ...notes(run)].join(" ")}</span>
      </div>
    </div>
  );
}

function read(): Run {
  return {
    batches: batches.value,
    columns: columns.value,
    shown: shown.value,
    pinned: shownFrame.value !== null,
  };
}

/** Say what is not in the table or will not be in a saved file. */
function notes(run: Run): string[] {
  const said: string[] = [];
  const images = run.columns.filter(isImage).map((column) => column.name);
  if (images.length) said.push(`The CSV leaves out ${images.join(", ")}.`);
  const first = firstFrame(run.batches);
  if (first > 0) said.push(`Frames before ${first.toLocaleString("en")} are no longer kept.`);
  const whole = firstWithImages(run.batches);
  if (images.length && whole > first) {
    said.push(`Planes and pictures before frame ${whole.toLocaleString("en")} are no longer kept.`);
  }
  return said;
}

/** Say that the last frame has not come to its end; empty if it has. */
function brokenOff(): string {
  const seen = view.value;
  const failed = seen?.ended && (seen.status === "failed" || seen.status === "cycle-limit");
  if (!failed || seen.frame < frameCount.value) return "";
  const where = seen.frame < 0 ? "the setup" : `frame ${seen.frame.toLocaleString("en")}`;
  return `The run broke off in ${where}, which is left out.`;
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
