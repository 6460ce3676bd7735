/** The verdicts on the `; expect:` lines of the program. */

import { computed, signal } from "@preact/signals";
import type { JSX } from "preact";
import { useRef } from "preact/hooks";
import { act } from "../actions";
import type { Verdict } from "../protocol";
import { heard } from "../say";
import { project, verdicts } from "../store";
import { type RunGroup, groups, summary } from "./verdicts";

const EXAMPLE = "; run: grey levels=0,128,255\n; expect: frames == 3\n; expect: cycles <= 2000\n";

const copied = signal(false);

/** True if some file of the program has an expectation. */
const expects = computed(() =>
  Object.values(project.value.files).some((text) => /^\s*;\s*expect:/m.test(text)),
);

/** The verdicts by run and machine, and a button that judges anew. */
export function Checks(): JSX.Element {
  const all = verdicts.value;
  return (
    <div class="results-checks">
      <div class="results-bar">
        <button type="button" onClick={() => act().check()}>
          Check
        </button>
        <span role="status">{summary(all, expects.value)}</span>
      </div>
      {!expects.value && <Explanation />}
      {all && groups(all).map((group) => <Group key={group.name} group={group} />)}
    </div>
  );
}

function Group({ group }: { group: RunGroup }): JSX.Element {
  const judged = group.verdicts.filter(({ holds }) => holds !== null);
  const held = judged.filter(({ holds }) => holds).length;
  return (
    <section class="results-group" aria-label={group.name}>
      <h4>
        {group.name}{" "}
        <span class="results-note">
          {judged.length ? `${held} of ${judged.length} hold` : "not run"}
        </span>
      </h4>
      <ul>
        {group.verdicts.map((verdict, at) => (
          <li key={at}>
            <Line verdict={verdict} />
          </li>
        ))}
      </ul>
    </section>
  );
}

function Line({ verdict }: { verdict: Verdict }): JSX.Element {
  const { holds, claim, found, place } = verdict;
  return (
    <button
      type="button"
      class="results-verdict"
      title={`Go to ${place.file}, line ${place.line}`}
      onClick={() => act().show(place.file, place.line)}
    >
      {holds === null ? (
        <span class="results-note">– not run</span>
      ) : (
        <span class={holds ? "results-good" : "results-bad"}>{holds ? "✓ holds" : "✗ fails"}</span>
      )}
      <code>{claim}</code>
      <span class="results-note">line {place.line}</span>
      {found && <span class="results-found">{found}</span>}
    </button>
  );
}

/** Copy the example; select it where the browser does not let a page copy. */
async function copy(shown: HTMLElement | null): Promise<void> {
  try {
    await navigator.clipboard.writeText(EXAMPLE);
    copied.value = true;
  } catch {
    if (shown) window.getSelection()?.selectAllChildren(shown);
  }
}

function Explanation(): JSX.Element {
  const example = useRef<HTMLPreElement>(null);
  return (
    <div class="results-explanation">
      <p>
        An expectation is a comment that says what a run must send or cost, and <b>Check</b> compares
        it with what the chip does. Copy this to the top of your program to try it:
      </p>
      <pre ref={example} tabIndex={0} aria-label="Example of expectations">
        {EXAMPLE}
      </pre>
      <button type="button" onClick={() => heard(copy(example.current))}>
        {copied.value ? "Copied" : "Copy example"}
      </button>
    </div>
  );
}
