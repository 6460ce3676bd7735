/** Bounds the memory that a long run takes. */

import type { FrameBatch, OutputColumn } from "../protocol";
import { endFrame } from "./frames";

/** How much of a run is kept. */
export interface Keep {
  /** Frames with their numbers and lists. */
  frames: number;
  /** The newest of them with their planes, pictures and input frames too. */
  images: number;
  /** Frames that older batches are joined to: few large batches are found and drawn faster. */
  block: number;
}

const KEEP: Keep = { frames: 200_000, images: 2_000, block: 8_192 };

/**
 * Return the batches without what is too old to be kept; the same array if all is kept.
 *
 * Call it with each new batch. It works by the block, so that the work is small on average and
 * somewhat more than `keep` may remain: a quarter more images, a block more frames.
 */
export function trim(batches: FrameBatch[], keep: Keep = KEEP): FrameBatch[] {
  const end = endFrame(batches);
  const [oldest] = batches;
  if (!oldest) return batches;
  const full = batches.find((batch) => batch.cycles.length && !isBare(batch));
  const tooMany =
    (full !== undefined && end - full.first > keep.images * 1.25) ||
    batches.length > keep.images * 1.5;
  const tooLong = end - oldest.first > keep.frames + keep.block;
  if (!tooMany && !tooLong) return batches;
  const kept = tooMany ? strip(batches, end - keep.images, keep.block) : [...batches];
  return tooLong ? drop(kept, end - keep.frames) : kept;
}

/** Return the batches with only numbers and lists before frame `from`. */
function strip(batches: FrameBatch[], from: number, block: number): FrameBatch[] {
  const done: FrameBatch[] = [];
  let group: FrameBatch[] = [];
  let length = 0;
  const close = (): void => {
    if (group.length) done.push(join(group));
    group = [];
    length = 0;
  };
  for (const batch of batches) {
    const after = batch.first + batch.cycles.length;
    const cut = Math.min(after, Math.max(batch.first, from)) - batch.first;
    if (cut > 0) {
      if (length + cut > block) close();
      group.push(bare(cut < batch.cycles.length ? part(batch, 0, cut) : batch));
      length += cut;
    }
    if (cut < batch.cycles.length || !batch.cycles.length) {
      close();
      done.push(cut > 0 ? part(batch, cut, batch.cycles.length) : batch);
    }
  }
  close();
  return done;
}

/** Return the batches without those that end before frame `from`; what the setup sent remains. */
function drop(batches: FrameBatch[], from: number): FrameBatch[] {
  const setup = batches[0]?.setup;
  const kept = batches.filter((batch) => batch.first + batch.cycles.length > from);
  const [first, ...rest] = kept;
  if (!first || !setup) return kept;
  return [{ ...first, setup }, ...rest];
}

function isBare(batch: FrameBatch): boolean {
  return (
    !batch.frames &&
    Object.values(batch.outputs).every((column) => !("rows" in column) || !column.values.length)
  );
}

function bare(batch: FrameBatch): FrameBatch {
  if (isBare(batch)) return batch;
  const outputs: Record<string, OutputColumn> = {};
  for (const [name, column] of Object.entries(batch.outputs)) {
    outputs[name] = "rows" in column ? { ...column, values: [] } : column;
  }
  return { ...batch, frames: null, outputs };
}

/** Return the frames `start` to `end` of a batch. Bytes are copied, or all would stay in memory. */
function part(batch: FrameBatch, start: number, end: number): FrameBatch {
  const outputs: Record<string, OutputColumn> = {};
  for (const [name, column] of Object.entries(batch.outputs)) {
    outputs[name] =
      "rows" in column
        ? { ...column, values: column.values.slice(start, end).map((one) => one && one.slice()) }
        : ({ ...column, values: column.values.slice(start, end) } as OutputColumn);
  }
  const size = (batch.frames?.length ?? 0) / batch.cycles.length;
  const { setup, ...rest } = batch;
  return {
    ...rest,
    ...(setup && start === 0 ? { setup } : {}),
    first: batch.first + start,
    cycles: batch.cycles.slice(start, end),
    instructions: batch.instructions.slice(start, end),
    outputs,
    frames: batch.frames?.slice(start * size, end * size) ?? null,
  };
}

/** Return consecutive batches without images as one. */
function join(group: FrameBatch[]): FrameBatch {
  const first = group[0] as FrameBatch;
  if (group.length === 1) return first;
  const names = new Set(group.flatMap((batch) => Object.keys(batch.outputs)));
  const outputs: Record<string, OutputColumn> = {};
  for (const name of names) outputs[name] = joinColumn(group, name);
  return {
    ...first,
    cycles: joinNumbers(group.map((batch) => batch.cycles)),
    instructions: joinNumbers(group.map((batch) => batch.instructions)),
    outputs,
  };
}

function joinColumn(group: FrameBatch[], name: string): OutputColumn {
  const columns = group.map((batch) => batch.outputs[name]);
  const known = columns.find((column) => column !== undefined) as OutputColumn;
  if ("rows" in known) return { ...known, values: [] };
  if (known.kind === "list") {
    const values = group.flatMap((batch, at) => {
      const column = columns[at];
      if (column?.kind === "list") return column.values;
      return new Array<null>(batch.cycles.length).fill(null);
    });
    return { ...known, values };
  }
  const parts = group.map((batch, at) => {
    const column = columns[at];
    return column?.values instanceof Float64Array
      ? column.values
      : new Float64Array(batch.cycles.length).fill(Number.NaN);
  });
  return { ...known, values: joinNumbers(parts) };
}

function joinNumbers(parts: Float64Array[]): Float64Array {
  const whole = new Float64Array(parts.reduce((sum, one) => sum + one.length, 0));
  let at = 0;
  for (const one of parts) {
    whole.set(one, at);
    at += one.length;
  }
  return whole;
}
