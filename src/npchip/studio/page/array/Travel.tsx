/** Steps forward and back, and where the chip stands. */

import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { act } from "../actions";
import type { ChipView, ProgramInfo, Word } from "../protocol";
import { program, project, view } from "../store";
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
      go(way);
    };
    addEventListener("keydown", press);
    return () => removeEventListener("keydown", press);
  }, []);
  return (
    <div class="array-travel" data-letters>
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
    </div>
  );
}

function WayButton({ way }: { way: Way }): JSX.Element {
  const keys = [way.key, way.letter].filter(Boolean).join(" or ");
  return (
    <button
      type="button"
      aria-label={way.name}
      aria-keyshortcuts={way.key?.replace("Ctrl", "Control") ?? undefined}
      title={`${way.name} (${keys}): ${way.does}`}
      onClick={() => go(way)}
    >
      {way.back && <span aria-hidden="true">◀</span>}
      {way.short && ` ${way.short}`}
    </button>
  );
}

function Standing({ now, made }: { now: ChipView; made: ProgramInfo }): JSX.Element {
  const word = made.words[now.address];
  return (
    <dl class="array-standing">
      <div class="array-next">
        <dt>{now.ended ? "ended at" : "next"}</dt>
        <dd>
          <code>{word?.text ?? "past the end of the program"}</code>
          {word && <Lines word={word} />}
          <span class="array-muted">{placeText(made, now.address)}</span>
        </dd>
      </div>
      <div>
        <dt>calls</dt>
        <dd>
          <Calls now={now} made={made} />
        </dd>
      </div>
      <div>
        <dt>frame</dt>
        <dd>
          {now.frame < 0 ? "none yet" : now.frame}: {counts(now.frameCycles, now.frameInstructions)}
        </dd>
      </div>
      <div>
        <dt>run</dt>
        <dd>{counts(now.cycles, now.instructions)}</dd>
      </div>
    </dl>
  );
}

/** An address with the label before it, if there is one. */
function placeText(made: ProgramInfo, address: number): string {
  const plain = `address ${address}`;
  const text = addressText(made, address);
  return text === plain ? plain : `${text} (${plain})`;
}

/** The open calls, the newest first. */
function Calls({ now, made }: { now: ChipView; made: ProgramInfo }): JSX.Element {
  const calls = openCalls(made, now.stack);
  if (!calls.length) return <>none</>;
  return (
    <ol class="array-inline">
      {calls.map(({ routine, caller, at }, index) => {
        const from = `called from ${at ? `${at.file}:${at.line}` : `address ${caller}`}`;
        return (
          <li key={index}>
            {at ? (
              <button
                type="button"
                title={from}
                aria-label={`${routine}, ${from}`}
                onClick={() => act().show(at.file, at.line)}
              >
                {routine}
              </button>
            ) : (
              <span title={from}>{routine}</span>
            )}
          </li>
        );
      })}
    </ol>
  );
}

/** The line of the instruction, and those of the macros around it. */
function Lines({ word }: { word: Word }): JSX.Element {
  const { origins } = word;
  const first = origins[0];
  const source = first && project.value.files[first.file]?.split("\n")[first.line - 1];
  const text = source?.split(";")[0]?.trim().replace(/\s+/g, " ");
  return (
    <ul class="array-inline">
      {origins.map(({ file, line }, index) => (
        <li key={index}>
          <button
            type="button"
            title={index ? "Show the use of the macro" : "Show the line"}
            onClick={() => act().show(file, line)}
          >
            {file}:{line}
          </button>
          {index === 0 && text !== word.text && <code class="array-muted">{text}</code>}
        </li>
      ))}
    </ul>
  );
}

function counts(cycles: number, instructions: number): string {
  return `${number(cycles)} cycle${cycles === 1 ? "" : "s"}, ${number(instructions)} instruction${instructions === 1 ? "" : "s"}`;
}

function number(value: number): string {
  return value.toLocaleString("en");
}
