/** Answers questions about the results with the page's own code. */

import type { ChipView, FrameBatch, Verdict } from "../../../src/npchip/studio/page/protocol";
import {
  cyclesOf,
  columnsOf,
  endFrame,
  firstFrame,
  firstWithImages,
  inputFrame,
  rangeOf,
  sentIn,
} from "../../../src/npchip/studio/page/results/frames";
import { byLabel, byLine, percent, ranked } from "../../../src/npchip/studio/page/results/parts";
import { rowAfterKey, visibleRows } from "../../../src/npchip/studio/page/results/rows";
import { toCsv, toJson } from "../../../src/npchip/studio/page/results/save";
import { centerOf, markKinds, marksOf } from "../../../src/npchip/studio/page/results/scene";
import { bins, summarise } from "../../../src/npchip/studio/page/results/series";
import { trim } from "../../../src/npchip/studio/page/results/trim";
import { groups, summary } from "../../../src/npchip/studio/page/results/verdicts";
import { type Recorded, batchesOf, clipOf } from "./batches";
import { answering } from "../../support/answering";

interface Question {
  ask: "saved" | "marks" | "ranges" | "parts" | "trimmed" | "long" | "rows" | "percents" | "series" | "verdicts";
  run: Recorded;
  size: number;
  keep: { frames: number; images: number; block: number };
  shares: number[];
  bins: number;
  live: boolean;
  verdicts: Verdict[];
}

const answers: Record<Question["ask"], (question: Question) => unknown> = {
  saved: ({ run, size }) => {
    const { document, program } = run;
    const view = { ...document, ended: true } as unknown as ChipView;
    const batches = batchesOf(run, size);
    return {
      csv: toCsv(program, batches),
      json: toJson(program, batches, view).join(""),
      unknown: toJson(program, batches.map(({ setup: _, ...batch }) => batch), view).join(""),
      running: toJson(program, batches, { ...view, ended: false }).join(""),
    };
  },
  marks: ({ run, size, live }) => {
    const batches = batchesOf(run, size);
    const kinds = markKinds(run.program, columnsOf(run.program, batches));
    // The frames come with the batches, as a camera's do, or are those of the clip.
    const bare = batches.map((batch) => ({ ...batch, frames: null }));
    const [from, source] = live ? [batches, "live" as const] : [bare, clipOf(run)];
    const frames = run.document.frames.map((_, frame) => ({
      ...marksOf(from, frame, kinds, source),
      path: centerOf(batches, frame, kinds),
    }));
    return { kinds, frames };
  },
  ranges: ({ run, size }) => {
    const batches = batchesOf(run, size);
    return run.program.outputs.map(({ name }) => rangeOf(batches, name));
  },
  parts: ({ run }) => {
    const cycles = Float64Array.from(run.profile);
    return {
      labels: byLabel(run.program, cycles),
      lines: byLine(run.program, cycles),
      ranked: ranked(byLine(run.program, cycles)),
    };
  },
  trimmed: ({ run, size, keep }) => {
    let batches: FrameBatch[] = [];
    for (const batch of batchesOf(run, size)) batches = trim([...batches, batch], keep);
    return seen(batches, run);
  },
  long: () => {
    const block = 1_000;
    let batches: FrameBatch[] = [];
    let most = 0;
    const started = performance.now();
    for (let first = 0; first < 300_000; first += block) {
      const cycles = new Float64Array(block).fill(7);
      batches = trim([...batches, { ...empty(first), cycles, instructions: cycles }]);
      most = Math.max(most, endFrame(batches) - firstFrame(batches));
    }
    const milliseconds = performance.now() - started;
    // One frame at a time, as a camera gives them.
    let single: FrameBatch[] = [];
    let longest = 0;
    for (let first = 0; first < 20_000; first++) {
      const one = new Float64Array([first]);
      single = trim([...single, { ...empty(first), cycles: one, instructions: one }]);
      longest = Math.max(longest, single.length);
    }
    const right = [0, 1, 8_191, 8_192, 19_999].every((frame) => cyclesOf(single, frame) === frame);
    return { most, milliseconds, longest, right, batches: batches.length };
  },
  rows: () => ({
    few: visibleRows(200, 0, 280),
    top: visibleRows(100_000, 0, 280),
    middle: visibleRows(100_000, 28 * 50_000, 280),
    end: visibleRows(100_000, 28 * 100_000, 280),
    keys: ["ArrowUp", "ArrowDown", "PageDown", "Home", "End", "a"].map((key) =>
      rowAfterKey(key, 0, 100, 280),
    ),
  }),
  series: ({ run, size, bins: count }) => {
    const batches = batchesOf(run, size);
    const frames = run.document.frames.length;
    const names = ["cycles", ...run.program.outputs.map((output) => output.name)];
    return names.map((name) => {
      const { low, high } = bins(batches, name, frames, count);
      return { name, summary: summarise(batches, name), low: [...low], high: [...high] };
    });
  },
  verdicts: ({ verdicts }) => ({
    groups: groups(verdicts),
    all: summary(verdicts, true),
    held: summary(verdicts.filter((verdict) => verdict.holds), true),
    none: [summary(null, true), summary(null, false), summary([], true)],
  }),
  percents: ({ shares }) => shares.map(percent),
};

function empty(first: number): FrameBatch {
  const none = new Float64Array(0);
  return { first, cycles: none, instructions: none, outputs: {}, frames: null };
}

/** Return what is left of every frame. */
function seen(batches: FrameBatch[], { program, document }: Recorded) {
  const lengths = batches.map((batch) => batch.cycles.length);
  const frames = document.frames.map((_, frame) => ({
    cycles: cyclesOf(batches, frame) ?? null,
    input: inputFrame(batches, frame, null)?.length ?? 0,
    outputs: Object.fromEntries(
      program.outputs.map(({ name }) => {
        const sent = sentIn(batches, name, frame);
        return [name, sent === undefined ? "gone" : sent instanceof Uint8Array ? [...sent] : sent];
      }),
    ),
  }));
  const gaps = batches.filter((batch, at) => {
    const before = batches[at - 1];
    return before && before.first + before.cycles.length !== batch.first;
  });
  return {
    lengths,
    frames,
    gaps: gaps.length,
    setup: batches[0]?.setup ?? null,
    first: firstFrame(batches),
    images: firstWithImages(batches),
  };
}

await answering((question: Question) => answers[question.ask](question));
