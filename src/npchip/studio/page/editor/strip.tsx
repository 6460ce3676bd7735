/** The line under the text: mistakes, words left, cycles of a frame, and the line of the cursor. */

import type { ReadonlySignal } from "@preact/signals";
import type { JSX } from "preact";
import { compiled, diagnostics, program } from "../store";
import { countText } from "./mistakes";
import { cyclesText, wordsText } from "./sums";

/** The strip. `line` says what stands beside the line of the cursor. */
export function Strip({ line }: { line: ReadonlySignal<string> }): JSX.Element {
  const all = diagnostics.value;
  // With mistakes there is no new program: what is said of the last one is marked as old.
  const fresh = compiled.value?.program ?? null;
  const known = fresh ?? program.value;
  const errors = all.some(({ severity }) => severity === "error");
  const worst = errors ? "✕ " : all.length ? "▲ " : "✓ ";
  return (
    <div class="editor-strip">
      <span role="status" class={errors ? "editor-fault-error" : ""}>
        {compiled.value ? (
          <>
            <span aria-hidden="true">{worst}</span>
            {countText(all)}
          </>
        ) : (
          "Not assembled yet"
        )}
      </span>
      {known && <span>{wordsText(known)}</span>}
      {known && cyclesText(known) && <span>{cyclesText(known)}</span>}
      {known && !fresh && <span>(before the mistakes)</span>}
      <span class="editor-line">{line.value}</span>
    </div>
  );
}
