/** Checks of a program that is edited, cancelled or asked for twice meanwhile. Prints what came of it, as JSON. */

import { next, settled } from "./asking";
import { check } from "../../../src/npchip/studio/page/shell/checks";
import { events } from "../../../src/npchip/studio/page/shell/chip";
import { startChip } from "../../../src/npchip/studio/page/shell/parts";
import { message, progress, project, verdicts } from "../../../src/npchip/studio/page/store";

startChip(events);
const place = { file: "a.s", line: 1, column: 1, length: 1 };
const run = { name: "run", place, frames: null, levels: null, machine: "default", defines: {}, memory: [], maxCycles: 9 };
const program = { machine: { np_rows: 8, np_cols: 10 } };
const files = (text: string) => ({ main: "a.s", files: { "a.s": text } });
const textOf = (asked: { args: unknown[] }): unknown =>
  (asked.args[0] as { project: { files: Record<string, string> } }).project.files["a.s"];
const verdict = (claim: string) => [{ run: "run", machine: "default", claim, place, holds: true, found: "" }];
const now = (): unknown => ({ said: message.value.text, kind: message.value.kind, shown: progress.value, verdicts: verdicts.value?.map(({ claim }) => claim) ?? null });
const found: Record<string, unknown> = {};

/** Let a check go up to its run in the chip. Return the texts that were compiled. */
async function toRun(): Promise<unknown[]> {
  const tests = await next("tests");
  tests.answer({ runs: [run], diagnostics: [] });
  const compile = await next("compile");
  compile.answer({ diagnostics: [], program, module: null }, new Uint8Array(8));
  return [textOf(tests), textOf(compile)];
}

// An edit between the answers.
project.value = files("old");
const edited = check();
const tests = await next("tests");
project.value = files("new");
tests.answer({ runs: [run], diagnostics: [] });
await edited;
found.edited = { ...(now() as object), text: textOf(tests) };

const late = check();
found.texts = await toRun();
project.value = files("newer");
(await next("whole")).answer({});
(await next("judge")).answer(verdict("of the old text"));
await late;
found.late = now();

// Cancel, while the chip is at work.
const cancelled = check();
await toRun();
const whole = await next("whole");
progress.value?.cancel?.();
await next("stopWhole");
whole.answer({});
await cancelled;
found.cancelled = now();

// The second of two checks counts.
const first = check();
await toRun();
const old = await next("whole");
const second = check();
await settled();
await toRun();
old.answer({});
await first;
(await next("whole")).answer({});
(await next("judge")).answer(verdict("holds"));
await second;
found.twice = now();
console.log(JSON.stringify(found));
process.exit(0);
