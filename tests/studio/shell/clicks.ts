/**
 * Clicks about in the shell at random, and looks whether the page ever shows what another run has
 * told. Parameters: the folder of the page's files with `truth.json`, the first seed, and how many.
 */

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { below, draw, elapse, random, seeded, turns } from "./surroundings";
import "../../../src/npchip/studio/page/machine/worker";
import { actions } from "../../../src/npchip/studio/page/shell/carry";
import { changePace, events } from "../../../src/npchip/studio/page/shell/chip";
import { chooseBundled } from "../../../src/npchip/studio/page/shell/clips";
import { startChip } from "../../../src/npchip/studio/page/shell/parts";
import { openExample } from "../../../src/npchip/studio/page/shell/project";
import type { Travel } from "../../../src/npchip/studio/page/protocol";
import * as store from "../../../src/npchip/studio/page/store";

/** Cycles and numbers of the frames, by program and clip. */
type Truth = Record<string, Record<string, { cycles: number; outputs: Record<string, unknown> }[]>>;

const [, , folder = ".", from = "0", count = "1"] = process.argv;
const truth = JSON.parse(readFileSync(join(folder, "truth.json"), "utf8")) as Truth;
const programs = Object.keys(truth);
const clips = Object.keys(Object.values(truth)[0] ?? {});
const faults: string[] = [];
let told: string[] = [];
let compared = 0;
/** What was chosen last, and has to be there in the end. */
const last = { program: "", clip: "" };
const late: Promise<unknown>[] = [];

startChip(events);

function report(seed: number, text: string): void {
  faults.push(`seed ${seed}: ${text}, after ${told.slice(-12).join(", ")}`);
}

/** The frames that the page shows, in plain form. */
function shown() {
  return store.batches.value.flatMap((batch) =>
    Array.from(batch.cycles, (cycles, index) => ({
      cycles,
      outputs: Object.fromEntries(
        Object.entries(batch.outputs).map(([name, column]) => {
          const value = column.values[index] ?? null;
          return [name, Number.isNaN(value) ? null : value];
        }),
      ),
    })),
  );
}

/** Compare what is shown with what the program in the chip gives on the clip. */
function compare(seed: number, isWhole: boolean): void {
  let next = 0;
  for (const batch of store.batches.value) {
    if (batch.first !== next) return report(seed, `frame ${batch.first} follows ${next - 1}`);
    next += batch.cycles.length;
  }
  const clip = store.clip.value;
  const program = store.program.value?.name;
  if (!program || !clip || clip === "live") return;
  const wanted = truth[program]?.[clip.name] ?? [];
  const found = shown();
  if (isWhole && found.length !== wanted.length) {
    report(seed, `${found.length} frames of ${program} on ${clip.name}, not ${wanted.length}`);
  }
  for (const [index, frame] of found.entries()) {
    compared++;
    const other = JSON.stringify(wanted[index]);
    if (JSON.stringify(frame) === other) continue;
    report(seed, `frame ${index} of ${program} on ${clip.name} is ${JSON.stringify(frame)}, not ${other}`);
    return;
  }
}

/** Note an example, which comes with the clip that shows it best. */
function chosen(name: string): void {
  last.program = name;
  last.clip = clips[programs.indexOf(name) % clips.length] as string;
}

/** Do something as a reader does, who does not wait for what comes of it. */
function click(): void {
  const does = (text: string, work: () => unknown): void => {
    told.push(text);
    late.push(Promise.resolve(work()).catch((fault: unknown) => void faults.push(String(fault))));
  };
  const what = below(14);
  if (what < 2) {
    const name = draw(programs);
    chosen(name);
    does(`example ${name}`, () => openExample(name));
  } else if (what < 4) {
    const name = draw(clips);
    last.clip = name;
    does(`clip ${name}`, () => chooseBundled(name));
  } else if (what < 7) does("run", () => actions.run());
  else if (what < 8) does("pause", () => actions.pause());
  else if (what < 10) does("reset", () => actions.reset());
  else if (what < 12) {
    const travel = draw<Travel>([{ to: "step" }, { to: "frame" }, { to: "over" }]);
    const isBack = random() < 0.5;
    does(`${isBack ? "back" : "go"} ${travel.to}`, () => actions.go(travel, isBack));
  } else does("pace", () => changePace(draw(["max", { unit: "frames", rate: 1000 }])));
}

/** Let timers go off. */
function slept(): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, 1));
}

async function settle(seed: number): Promise<void> {
  for (let i = 0; i < 400; i++) {
    await Promise.all(late.splice(0));
    await turns(15);
    await slept();
    if (!store.running.value && !late.length) return;
    if (i === 40) actions.pause();
  }
  report(seed, "it does not come to rest");
}

async function sequence(seed: number): Promise<void> {
  seeded(seed);
  told = [];
  for (let i = 0; i < 12; i++) {
    click();
    await turns(random() < 0.4 ? below(3) : below(80));
    // Between two clicks at a time, what is shown may be of a program that is on its way out.
    if (late.length === 0) compare(seed, false);
  }
  await settle(seed);
  compare(seed, false);
  const clip = store.clip.value;
  const found = { program: store.program.value?.name, clip: clip && clip !== "live" && clip.name };
  if (JSON.stringify(found) !== JSON.stringify(last)) {
    report(seed, `${JSON.stringify(found)} is there, not ${JSON.stringify(last)}`);
  }
  await changePace("max");
  actions.reset();
  await settle(seed);
  for (let i = 0; i < 400 && store.view.value?.instructions !== 0; i++) await slept();
  told.push("reset, run to the end");
  actions.run();
  for (let i = 0; i < 400 && !(store.view.value?.ended && !store.running.value); i++) await slept();
  compare(seed, true);
}

/** A step that takes long, for which a run was paused, is not taken for a chip that hears nothing. */
async function stepLong(): Promise<void> {
  await openExample(programs[0] as string);
  await chooseBundled("coin_slide");
  await changePace({ unit: "frames", rate: 1 });
  actions.run();
  for (let i = 0; i < 400 && !store.running.value; i++) await turns(1);
  await slept();
  let seen = 0;
  const end = store.running.subscribe(() => seen++);
  actions.go({ to: "instruction", number: 32_000 });
  for (let i = 0; i < 4_000 && seen < 3; i++) await turns(1); // as it is, off, and on again
  if (seen !== 3) faults.push("the step did not begin");
  elapse();
  end();
  await settle(-2);
  const at = store.view.value?.instructions;
  if (at !== 32_000) faults.push(`the step has ended at ${at}`);
}

// A first program, as when the page opens.
seeded(0);
chosen(programs[0] as string);
await openExample(programs[0] as string);
await settle(-1);
for (let seed = Number(from); seed < Number(from) + Number(count); seed++) {
  await sequence(seed);
  if (faults.length > 5) break;
}
try {
  await stepLong();
} catch (fault) {
  faults.push(String(fault));
}
console.log(JSON.stringify({ compared, faults }));
process.exit(0);
