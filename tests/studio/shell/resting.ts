/** Run is pressed while a step back is under way: it goes on from there. Prints JSON. */

import { next, settled } from "./asking";
import { bringUp, events, go, pause, run } from "../../../src/npchip/studio/page/shell/chip";
import { startChip } from "../../../src/npchip/studio/page/shell/parts";
import { project, running } from "../../../src/npchip/studio/page/store";

startChip(events);
project.value = { main: "a.s", files: { "a.s": "one" } };
const program = {
  words: [{ origins: [{ file: "a.s", line: 1 }], text: "", cycles: 1 }],
  machine: { np_rows: 8, np_cols: 10 },
};
const found: Record<string, unknown> = {};

const up = bringUp();
(await next("compile")).answer({ diagnostics: [], program, module: null }, new Uint8Array(8));
(await next("load")).answer(null);
(await next("breakpoints")).answer(null);
await up;

async function stepBackAnd(...pressed: (() => unknown)[]): Promise<void> {
  const back = go({ to: "step" }, true);
  const way = await next("go");
  for (const press of pressed) void press();
  await settled();
  way.answer({ reason: "step", text: "" });
  await back;
  await settled();
}

await stepBackAnd(run, pause);
found.paused = running.value;
await stepBackAnd(run);
found.running = running.value;
found.asked = (await next("run")).name;
console.log(JSON.stringify(found));
process.exit(0);
