/** The panels below the picture, one at a time. */

import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { ArrayView } from "../array/ArrayView";
import { Breaks } from "../array/Breaks";
import { Processor } from "../array/Processor";
import { Chart } from "../results/chart";
import { Checks } from "../results/checks";
import { Cycles } from "../results/cycles";

function Costs(): JSX.Element {
  return (
    <>
      <Cycles />
      <Chart />
    </>
  );
}

const PANELS: Record<string, () => JSX.Element> = {
  Array: ArrayView,
  Processor,
  Cycles: Costs,
  Checks,
  Stops: Breaks,
};

export const shownPanel = signal("Array");

export function Panels(): JSX.Element {
  const names = Object.keys(PANELS);
  const shown = shownPanel.value;
  const Shown = PANELS[shown] ?? ArrayView;
  const onKeyDown = (event: KeyboardEvent): void => {
    const at = names.indexOf(shown);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: names.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    const next = names[(to + names.length) % names.length] ?? shown;
    shownPanel.value = next;
    document.getElementById(`tab-${next}`)?.focus();
  };
  return (
    <>
      <div role="tablist" aria-label="Panels" class="shell-tabs" onKeyDown={onKeyDown}>
        {names.map((name) => (
          <button
            key={name}
            id={`tab-${name}`}
            role="tab"
            type="button"
            aria-selected={name === shown}
            aria-controls="shown-panel"
            tabIndex={name === shown ? 0 : -1}
            onClick={() => {
              shownPanel.value = name;
            }}
          >
            {name}
          </button>
        ))}
      </div>
      <div role="tabpanel" id="shown-panel" class="shell-panel" aria-labelledby={`tab-${shown}`}>
        <Shown />
      </div>
    </>
  );
}
