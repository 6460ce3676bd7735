/** The `; expect:` lines of the source, run apart from what the reader looks at. */

import type { Clip, CompileRequest, TestRun, Verdict } from "../protocol";
import { verdicts } from "../store";
import { loadBundled } from "../frames/bundled";
import { summary } from "../results/verdicts";
import { during, type Job } from "../control/jobs";
import { say } from "../say";
import { request, unlessChanged } from "./compile";
import { chip, compiler } from "./parts";

const CHANGED = "The program has changed during the check: press Check again";

/** Stops the check at work. */
let control = new AbortController();

/** Run every test line and show what holds. A check begins anew if another one is at work. */
export async function check(): Promise<void> {
  control.abort();
  const mine = (control = new AbortController());
  const { signal } = mine;
  signal.addEventListener("abort", () => chip().stopWhole(), { once: true });
  // One text, one machine: what is typed meanwhile is another program, of which nothing is said.
  const asked = request(true);
  const isSame = unlessChanged();
  const goesOn = (): boolean => {
    signal.throwIfAborted();
    return isSame();
  };
  const work = async (job: Job): Promise<void> => {
    const { runs, diagnostics } = await compiler().tests(asked);
    if (!goesOn()) return say(CHANGED);
    if (diagnostics.length) {
      throw new Error(diagnostics.map((each) => `line ${each.place?.line ?? "?"}: ${each.message}`).join("; "));
    }
    const found: Verdict[] = [];
    for (const [index, run] of runs.entries()) {
      job.tell(index / runs.length, `Checking ${run.name} on ${run.machine}`);
      found.push(...(await verdictsOf(run, asked, signal)));
      if (!goesOn()) return say(CHANGED);
    }
    verdicts.value = found;
    say(runs.length ? summary(found, true) : "This program has no expectations yet: add ; expect: lines");
  };
  await during("Checking the expectations", work, () => {
    mine.abort();
    say("The check was cancelled");
  });
}

async function verdictsOf(run: TestRun, asked: CompileRequest, signal: AbortSignal): Promise<Verdict[]> {
  const refused = (why: string): Verdict[] => [
    { run: run.name, machine: run.machine, claim: "", place: run.place, holds: null, found: why },
  ];
  if (run.refused) return refused(run.refused);
  const { machine } = asked;
  const made = await compiler().compile({
    ...asked,
    machine: run.machine === machine.name ? machine : { name: run.machine },
    defines: run.defines,
    memory: run.memory ?? [],
  });
  signal.throwIfAborted();
  if (!made.program || !made.module) return refused(made.diagnostics[0]?.message ?? "it has mistakes");
  const size = { rows: 8 * made.program.machine.np_rows, cols: 8 * made.program.machine.np_cols };
  let frames: Clip | null;
  try {
    frames = await framesOf(run, size);
  } catch (fault) {
    return refused(String(fault instanceof Error ? fault.message : fault));
  }
  signal.throwIfAborted();
  const document = await chip()
    .whole(made.module, made.program, frames, run.maxCycles)
    .finally(() => signal.throwIfAborted()); // a run that was stopped for that is no fault
  return compiler().judge(run.name, run.machine, document);
}

async function framesOf(run: TestRun, size: { rows: number; cols: number }): Promise<Clip | null> {
  if (run.levels) {
    const area = size.rows * size.cols;
    const data = new Uint8Array(area * run.levels.length);
    run.levels.forEach((level, index) => data.fill(level, index * area, (index + 1) * area));
    return { name: "levels", count: run.levels.length, ...size, data, fps: null };
  }
  if (run.frames === null) return null;
  const stem = run.frames.split("/").pop()?.replace(/\.[^.]*$/, "") ?? "";
  const all = await loadBundled(stem, size, run.fit).catch(() => {
    throw new Error(`the clip ${run.frames} is not in this page: only bundled clips can be checked here`);
  });
  const count = Math.min(run.first ?? all.count, all.count);
  return { ...all, count, data: all.data.slice(0, count * size.rows * size.cols) };
}
