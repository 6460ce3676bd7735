/** Breakpoints and a way to a line, while the text is not the program in the chip. Prints JSON. */

import { next } from "./asking";
import { breaksFollow } from "../../../src/npchip/studio/page/shell/carry";
import { bringUp, events, goToLine } from "../../../src/npchip/studio/page/shell/chip";
import { startChip } from "../../../src/npchip/studio/page/shell/parts";
import type { Travel } from "../../../src/npchip/studio/page/protocol";
import { breaks, project } from "../../../src/npchip/studio/page/store";

startChip(events);
const write = (text: string): void => {
  project.value = { main: "a.s", files: { "a.s": text } };
};
const programOf = (...lines: number[]) => ({
  words: lines.map((line) => ({ origins: [{ file: "a.s", line }], text: "", cycles: 1 })),
  machine: { np_rows: 8, np_cols: 10 },
});
/** Answer what is asked until a program is in the chip. */
async function putIn(program: unknown): Promise<void> {
  (await next("compile")).answer({ diagnostics: [], program, module: null }, new Uint8Array(8));
  (await next("load")).answer(null);
}
async function addresses(): Promise<unknown> {
  const asked = await next("breakpoints");
  asked.answer(null);
  return (asked.args[0] as { all: { addresses: number[] }[] }).all.map((each) => each.addresses);
}
const found: Record<string, unknown> = {};

write("one\ntwo\nthree");
const up = bringUp();
await putIn(programOf(1, 2, 3));
await addresses();
await up;
breaksFollow();
breaks.value = [{ file: "a.s", line: 2, condition: "" }];
found.before = await addresses();
// A line above pushes the breakpoint down; the program in the chip is as it was.
write("new\none\ntwo\nthree");
breaks.value = [{ file: "a.s", line: 3, condition: "" }];
found.after = await addresses();
breaks.value = [{ file: "a.s", line: 3, condition: "r0 > 1" }];
const condition = await next("condition");
found.condition = condition.args;
condition.answer({});
await addresses();

const gone = goToLine("a.s", 3, false);
await putIn(programOf(2, 3, 4));
const again = await next("condition");
found.again = again.args;
again.answer({});
found.anew = await addresses();
const go = await next("go");
found.travel = (go.args[0] as { travel: Travel }).travel;
go.answer({ reason: "step", text: "" });
found.why = [await gone, await goToLine("a.s", 1, true)];
console.log(JSON.stringify(found));
process.exit(0);
