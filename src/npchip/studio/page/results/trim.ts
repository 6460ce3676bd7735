/** Bounds the memory that a long run takes. */

import type { FrameBatch, OutputColumn } from "../protocol";
import { endFrame } from "./frames";

/** Limits of what is kept of a run. */
export interface Keep {
  /** Frames with their numbers and lists. */
  frames: number;
  /** The newest of them with their planes, pictures and input frames too. */
  images: number;
  /** Frames that older batches are joined to: few large batches are found and drawn faster. */
  block: number;
  /** Bytes that numbers and lists may take, and images: whichever bound is met first counts. */
  numberBytes: number;
  imageBytes: number;
}

export const KEEP: Keep = {
  frames: 200_000,
  images: 2_000,
  block: 8_192,
  numberBytes: 64 << 20,
  imageBytes: 128 << 20,
};
/** Fewest frames whose images are kept, however large they are. */
const LEAST_IMAGES = 16;

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
  const images = full ? mostImages(full, keep) : keep.images;
  const tooMany =
    (full !== undefined && end - full.first > images * 1.25) || batches.length > keep.images * 1.5;
  const tooLong = end - oldest.first > keep.frames + keep.block;
  const bytes = batches.reduce((sum, batch) => sum + numbersSize(batch), 0);
  const tooLarge = bytes > keep.numberBytes * 1.25;
  if (!tooMany && !tooLong && !tooLarge) return batches;
  const kept = tooMany ? strip(batches, end - images, keep) : [...batches];
  const from = Math.max(tooLong ? end - keep.frames : 0, tooLarge ? fitting(kept, keep.numberBytes) : 0);
  return from ? drop(kept, from) : kept;
}

/** Return how many frames with images like those of a batch may be kept. */
function mostImages(batch: FrameBatch, keep: Keep): number {
  let bytes = batch.frames?.length ?? 0;
  for (const column of Object.values(batch.outputs)) {
    if ("rows" in column) bytes += batch.cycles.length * column.rows * column.cols;
  }
  const each = Math.max(1, bytes / batch.cycles.length);
  return Math.min(keep.images, Math.max(LEAST_IMAGES, Math.floor(keep.imageBytes / each)));
}

/** The first frame of the newest batches whose numbers take up to `most` bytes; the last one stays. */
function fitting(batches: readonly FrameBatch[], most: number): number {
  let bytes = 0;
  for (let at = batches.length - 1; at > 0; at--) {
    bytes += numbersSize(batches[at] as FrameBatch);
    if (bytes + numbersSize(batches[at - 1] as FrameBatch) > most) return (batches[at] as FrameBatch).first;
  }
  return 0;
}

/** Sizes that were counted: a batch does not change. */
const sizes = new WeakMap<FrameBatch, number>();

/** Bytes of a batch's numbers and lists, about: an element takes 8, a list 32 for itself. */
function numbersSize(batch: FrameBatch): number {
  const known = sizes.get(batch);
  if (known !== undefined) return known;
  let size = 16 * batch.cycles.length;
  for (const column of Object.values(batch.outputs)) {
    if (column.kind === "list") for (const one of column.values) size += 32 + 8 * (one?.length ?? 0);
    else if (!("rows" in column)) size += 8 * column.values.length;
  }
  sizes.set(batch, size);
  return size;
}

/** Return the batches with only numbers and lists before frame `from`. */
function strip(batches: FrameBatch[], from: number, { block, numberBytes }: Keep): FrameBatch[] {
  const done: FrameBatch[] = [];
  let group: FrameBatch[] = [];
  let length = 0;
  let bytes = 0;
  const close = (): void => {
    if (group.length) done.push(join(group));
    group = [];
    length = bytes = 0;
  };
  for (const batch of batches) {
    const after = batch.first + batch.cycles.length;
    const cut = Math.min(after, Math.max(batch.first, from)) - batch.first;
    if (cut > 0) {
      const old = bare(cut < batch.cycles.length ? part(batch, 0, cut) : batch);
      const size = numbersSize(old);
      // Blocks are dropped as a whole, so none holds more than a part of all.
      if (length + cut > block || bytes + size > numberBytes / 8) close();
      group.push(old);
      length += cut;
      bytes += size;
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
