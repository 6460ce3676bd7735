/** The `; expect:` lines of the source, run apart from what the reader looks at. */

import type { Clip, TestRun, Verdict } from "../protocol";
import { machine, progress, verdicts } from "../store";
import { loadBundled } from "../frames/bundled";
import { distracted, request } from "./compile";
import { chip, compiler } from "./parts";
import { during, say, sayError } from "./say";

/** Stands for the claims of a run that the page cannot make. */
const CAN_RUN = "can run in the page";

/** Run every test line and show what holds. */
export async function check(): Promise<void> {
  await during("Checking what the source expects", async () => {
    const { runs, diagnostics } = await compiler().tests(request(false));
    if (diagnostics.length) {
      sayError(new Error(diagnostics.map((each) => `line ${each.place?.line ?? "?"}: ${each.message}`).join("; ")));
      return;
    }
    const found: Verdict[] = [];
    for (const [index, run] of runs.entries()) {
      progress.value = { text: `Checking ${run.name} on ${run.machine}`, share: index / runs.length };
      found.push(...(await verdictsOf(run)));
    }
    verdicts.value = found;
    say(runs.length ? summary(found) : "The source expects nothing yet: write ; expect: lines");
  });
}

function summary(found: Verdict[]): string {
  const judged = found.filter((each) => each.claim !== CAN_RUN);
  const holding = judged.filter((each) => each.holds).length;
  const left = found.length - judged.length;
  const rest = left ? `; ${left} run${left === 1 ? "" : "s"} cannot be made here: use npchip test` : "";
  return `${holding} of ${judged.length} expectations hold${rest}`;
}

async function verdictsOf(run: TestRun): Promise<Verdict[]> {
  const refused = (why: string): Verdict[] => [
    { run: run.name, machine: run.machine, claim: CAN_RUN, place: run.place, holds: false, found: why },
  ];
  if (run.refused) return refused(run.refused);
  distracted();
  const made = await compiler().compile({
    ...request(true),
    machine: run.machine === machine.value.name ? machine.value : { name: run.machine },
    defines: run.defines,
    memory: run.memory ?? [],
  });
  if (!made.program || !made.module) return refused(made.diagnostics[0]?.message ?? "it has mistakes");
  const size = { rows: 8 * made.program.machine.np_rows, cols: 8 * made.program.machine.np_cols };
  let frames: Clip | null;
  try {
    frames = await framesOf(run, size);
  } catch (fault) {
    return refused(String(fault instanceof Error ? fault.message : fault));
  }
  const document = await chip().whole(made.module, made.program, frames, run.maxCycles);
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
