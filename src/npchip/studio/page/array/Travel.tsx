/** Steps forward and back, and where the chip stands. */

import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { act } from "../actions";
import type { ChipView, ProgramInfo } from "../protocol";
import { program, project, running, stop, view } from "../store";
import { addressText, openCalls } from "./names";
import { go, obstacle, shortcuts, wayOf, type Way } from "./shortcuts";

export { shortcuts } from "./shortcuts";

/** Ways that differ in the direction only, the way back first, as on a player. */
const PAIRS: Way[][] = [...new Set(shortcuts.map(({ to }) => to))].map((to) =>
  shortcuts.filter((way) => way.to === to).toReversed(),
);

/** The buttons and keys that travel, and the place where the chip stands. */
export function Travel(): JSX.Element {
  useEffect(() => {
    const press = (event: KeyboardEvent): void => {
      if (event.defaultPrevented) return;
      const target = event.target instanceof Element ? event.target : null;
      const typing = target?.closest("input:not([type=radio]), textarea, select, [contenteditable], [role=menu]");
      const way = wayOf(event, !typing && Boolean(target?.closest("[data-letters]")));
      if (!way) return;
      event.preventDefault();
      if (!running.value) go(way);
    };
    addEventListener("keydown", press);
    return () => removeEventListener("keydown", press);
  }, []);
  return (
    <section class="array-travel" aria-label="Steps" data-letters>
      <div class="array-ways" role="group" aria-label="Step and go back">
        {PAIRS.map((pair) => (
          <span key={pair[0]?.to} class="array-pair">
            {pair.map((way) => (
              <WayButton key={way.name} way={way} />
            ))}
          </span>
        ))}
      </div>
      <p class="array-wrong" role="alert">
        {obstacle.value}
      </p>
      {view.value && program.value && <Standing now={view.value} made={program.value} />}
    </section>
  );
}

function WayButton({ way }: { way: Way }): JSX.Element {
  const keys = [way.key, way.letter].filter(Boolean).join(" or ");
  const bare = way.back && way.name.includes(",");
  return (
    <button
      type="button"
      aria-label={way.name}
      aria-keyshortcuts={way.key?.replace("Ctrl", "Control") ?? undefined}
      aria-disabled={running.value}
      title={`${way.name} (${keys}): ${way.does}`}
      onClick={() => {
        if (!running.value) go(way);
      }}
    >
      {way.back && <span aria-hidden="true">◀ </span>}
      {!bare && way.name}
      {!way.back && <span aria-hidden="true"> ▶</span>}
    </button>
  );
}

function Standing({ now, made }: { now: ChipView; made: ProgramInfo }): JSX.Element {
  const word = made.words[now.address];
  const calls = openCalls(made, now.stack);
  return (
    <dl class="array-standing">
      <dt>{now.ended ? "ended at" : "next"}</dt>
      <dd>
        <code>{word?.text ?? "behind the program's last word"}</code>
        <span class="array-muted">
          {" "}
          {addressText(made, now.address)} (address {now.address})
        </span>
        {word && <Lines origins={word.origins} />}
      </dd>
      <dt>calls</dt>
      <dd>
        {calls.length ? (
          <ol class="array-calls">
            {calls.map(({ routine, caller, at }, index) => (
              <li key={index}>
                <button type="button" disabled={!at} onClick={() => at && act().show(at.file, at.line)}>
                  {routine}
                </button>{" "}
                <span class="array-muted">from {at ? `${at.file}:${at.line}` : `address ${caller}`}</span>
              </li>
            ))}
          </ol>
        ) : (
          "none open"
        )}
      </dd>
      <dt>frame</dt>
      <dd>
        {now.frame < 0 ? "none yet" : now.frame}
        <span class="array-muted">
          {" "}
          {number(now.frameCycles)} cycles, {number(now.frameInstructions)} instructions
        </span>
      </dd>
      <dt>run</dt>
      <dd>
        {number(now.cycles)} cycles, {number(now.instructions)} instructions
      </dd>
      <dt>stopped</dt>
      <dd>{running.value ? "running" : reasonText()}</dd>
    </dl>
  );
}

/** The line of the instruction, and those of the macros around it. */
function Lines({ origins }: { origins: { file: string; line: number }[] }): JSX.Element {
  return (
    <ul class="array-lines">
      {origins.map(({ file, line }, index) => (
        <li key={index}>
          <button type="button" onClick={() => act().show(file, line)}>
            {index ? "in " : ""}
            {file}:{line}
          </button>{" "}
          <code>{project.value.files[file]?.split("\n")[line - 1]?.split(";")[0]?.trim()}</code>
        </li>
      ))}
    </ul>
  );
}

const REASONS = {
  paused: "paused",
  step: "after a step",
  breakpoint: "at a breakpoint",
  condition: "a condition holds",
  ended: "the run has ended",
  beginning: "at the beginning",
};

function reasonText(): string {
  const why = stop.value;
  if (!why) return view.value?.instructions ? "" : REASONS.beginning;
  return why.text || REASONS[why.reason];
}

function number(value: number): string {
  return value.toLocaleString("en");
}
