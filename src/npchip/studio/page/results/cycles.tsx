/** Shows where the cycles of a frame go. */

import { effect, signal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useState } from "preact/hooks";
import { act } from "../actions";
import type { ProgramInfo } from "../protocol";
import { library, program, project, running } from "../store";
import { type Part, byLabel, byLine, frameRate, percent, ranked } from "./parts";
import { shown } from "./shown";

const CLOCK_HZ = 10_000_000;
const MOST = 40;

const grouping = signal<"label" | "line">("label");

interface Measured {
  program: ProgramInfo;
  frame: number;
  cycles: Float64Array;
}

/** Measure the frame that is shown, whenever the chip rests. */
function useMeasured(): { measured: Measured | null; error: string } {
  const [state, set] = useState<{ measured: Measured | null; error: string }>({
    measured: null,
    error: "",
  });
  useEffect(() => {
    let timer = 0;
    let asked = 0;
    let known: { program: ProgramInfo; frame: number } | null = null;
    const dispose = effect(() => {
      const now = program.value;
      const frame = shown.value;
      window.clearTimeout(timer);
      asked += 1;
      if (frame < 0) known = null; // a reset: other frames will have these numbers
      if (running.value || !now || frame < 0) return;
      if (known?.program === now && known.frame === frame) return;
      const request = asked;
      // A slider passes many frames: only the one that it rests on is measured.
      timer = window.setTimeout(() => {
        act()
          .profile(frame)
          .then(
            (cycles) => {
              if (request !== asked) return;
              known = { program: now, frame };
              set({ measured: { program: now, frame, cycles }, error: "" });
            },
            (reason: unknown) => {
              if (request !== asked) return;
              const error = reason instanceof Error ? reason.message : String(reason);
              set({ measured: null, error });
            },
          );
      }, 150);
    });
    return () => {
      dispose();
      asked += 1;
      window.clearTimeout(timer);
    };
  }, []);
  return state;
}

/** The parts of the program by the cycles that they took, with bars. */
export function Cycles(): JSX.Element {
  const { measured, error } = useMeasured();
  return (
    <div class="results-cycles">
      {measured && measured.program === program.value ? (
        <Bars measured={measured} />
      ) : (
        <p class="results-empty">{error || waiting()}</p>
      )}
    </div>
  );
}

function waiting(): string {
  if (running.value) return "Pause to see where the cycles of a frame go.";
  return "Run a frame to see where its cycles go.";
}

function Bars({ measured }: { measured: Measured }): JSX.Element {
  const { frame, cycles } = measured;
  const group = grouping.value === "label" ? byLabel : byLine;
  const parts = ranked(group(measured.program, cycles));
  const total = parts.reduce((sum, part) => sum + part.cycles, 0);
  const dearest = parts[0]?.cycles ?? 1;
  return (
    <>
      <div class="results-bar">
        <strong>
          Frame {frame}: {total.toLocaleString("en")} cycles
        </strong>
        <label>
          by{" "}
          <select
            value={grouping.value}
            onChange={(event) => {
              grouping.value = event.currentTarget.value as typeof grouping.value;
            }}
          >
            <option value="label">label</option>
            <option value="line">source line</option>
          </select>
        </label>
      </div>
      <Limits cycles={total} budget={measured.program.budgets.cycles} />
      <ol class="results-parts">
        {parts.slice(0, MOST).map((part) => (
          <li key={part.name}>
            <PartButton
              part={part}
              instruction={measured.program.words[part.address]?.text ?? ""}
              share={part.cycles / total}
              length={part.cycles / dearest}
            />
          </li>
        ))}
      </ol>
      {parts.length > MOST && (
        <p class="results-note">and {parts.length - MOST} more with fewer cycles</p>
      )}
    </>
  );
}

function Limits({ cycles, budget }: { cycles: number; budget: number | null }): JSX.Element {
  return (
    <p class="results-note">
      {frameRate(cycles, CLOCK_HZ)} frames/s at 10 MHz (illustrative: decision, not silicon)
      {budget !== null && (
        <>
          {" · "}
          {cycles <= budget ? "✓ within" : "✗ over"} the budget of {budget.toLocaleString("en")}{" "}
          cycles ({percent(cycles / budget)})
        </>
      )}
    </p>
  );
}

function PartButton(props: {
  part: Part;
  /** Its first instruction, for lines whose source is not at hand. */
  instruction: string;
  /** Of all cycles. */
  share: number;
  /** Of the bar, relative to the longest. */
  length: number;
}): JSX.Element {
  const { part, instruction, share, length } = props;
  const { place } = part;
  const byLines = grouping.value === "line";
  return (
    <button
      type="button"
      class="results-part"
      aria-disabled={!place}
      title={place ? `Go to ${place.file}, line ${place.line}` : undefined}
      onClick={() => place && act().show(place.file, place.line)}
    >
      <span class="results-part-name">
        {byLines && place ? `${place.file.split("/").pop()}:${place.line} ` : part.name}
        {byLines && <code>{sourceText(place) || instruction}</code>}
      </span>
      <span class="results-part-count">{part.cycles.toLocaleString("en")}</span>
      <span class="results-part-share">{percent(share)}</span>
      <span class="results-part-bar" aria-hidden="true">
        <span style={{ width: `${100 * length}%` }} />
      </span>
    </button>
  );
}

/** Return a source line without its comment; empty if the page does not hold the file. */
function sourceText(place: Part["place"]): string {
  if (!place) return "";
  const text = project.value.files[place.file] ?? library.value[place.file];
  const line = text?.split("\n")[place.line - 1] ?? "";
  return (line.split(";")[0] ?? "").trim().replace(/\s+/g, " ");
}
