/** Shows the results of recorded runs without a chip: `?run=NAME&play=RATE`. */

import { render } from "preact";
import { type Actions, provide } from "../../../src/npchip/studio/page/actions";
import { Chart } from "../../../src/npchip/studio/page/results/chart";
import { Checks } from "../../../src/npchip/studio/page/results/checks";
import { Cycles } from "../../../src/npchip/studio/page/results/cycles";
import { Outputs } from "../../../src/npchip/studio/page/results/outputs";
import { Pictures } from "../../../src/npchip/studio/page/results/pictures";
import { trim } from "../../../src/npchip/studio/page/results/trim";
import type { ChipView, FrameBatch } from "../../../src/npchip/studio/page/protocol";
import * as store from "../../../src/npchip/studio/page/store";
import { type Recorded, batchesOf } from "./batches";

declare global {
  interface Window {
    /** What the panels asked for, for tests. */
    asked: unknown[][];
    store: typeof store;
    /** Show a run at once, over and over until it has `frames` frames. */
    load(run: Recorded, frames: number): void;
    /** Show a run frame by frame; `rate` frames a second. */
    play(run: Recorded, rate: number, frames: number): void;
  }
}

window.asked = [];
window.store = store;

function note(name: string): (...given: unknown[]) => void {
  return (...given) => void window.asked.push([name, ...given]);
}

let profile: number[] = [];
let frames = 1;
const actions = new Proxy({} as Actions, {
  get: (_, name: string) => {
    if (name === "profile") return async () => Float64Array.from(profile, (all) => Math.round(all / frames));
    if (name === "showFrame") {
      return (index: number | null) => {
        store.shownFrame.value = index;
        note(name)(index);
      };
    }
    return note(name);
  },
});
provide(actions);

function begin(run: Recorded): void {
  profile = run.profile;
  frames = run.document.frames.length;
  store.batches.value = [];
  store.shownFrame.value = null;
  store.program.value = run.program;
  store.view.value = { ...run.document, ended: true } as unknown as ChipView;
}

/** Return the batches of a run again, as those of later frames. */
function later(batches: FrameBatch[], by: number): FrameBatch[] {
  return batches.map(({ setup, ...batch }) => ({
    ...batch,
    ...(by || !setup ? {} : { setup }),
    first: batch.first + by,
  }));
}

window.load = (run, frames) => {
  begin(run);
  const once = batchesOf(run, 1000);
  const count = run.document.frames.length;
  let all: FrameBatch[] = [];
  for (let by = 0; by < frames; by += count) all.push(...later(once, by));
  all = trim(all);
  store.batches.value = all;
};

window.play = (run, rate, frames) => {
  begin(run);
  store.running.value = true;
  const once = batchesOf(run, 1);
  let sent = 0;
  const timer = setInterval(() => {
    const at = sent % once.length;
    const [batch] = later(once.slice(at, at + 1), sent - at);
    if (batch) store.batches.value = trim([...store.batches.value, batch]);
    sent += 1;
    if (sent < frames) return;
    clearInterval(timer);
    store.running.value = false;
  }, 1000 / rate);
};

render(
  <main class="dev">
    <section class="dev-pictures">
      <Pictures />
    </section>
    <section class="dev-outputs">
      <Outputs />
    </section>
    <section class="dev-cycles">
      <Chart />
      <Cycles />
    </section>
    <section class="dev-checks">
      <Checks />
    </section>
  </main>,
  document.body,
);
