/** A number over the frames of a run: what the chart draws and says. */

import type { FrameBatch } from "../protocol";
import { firstFrame } from "./frames";

/** Name of the cycles among the series; no output has it, as it is a word of the language. */
export const CYCLES = "cycles";

/** The extremes of a series, each with the first frame that has it. */
export interface Summary {
  count: number;
  least: number;
  leastAt: number;
  most: number;
  mostAt: number;
  newest: number;
}

function valuesIn(batch: FrameBatch, name: string): Float64Array | null {
  if (name === CYCLES) return batch.cycles;
  const values = batch.outputs[name]?.values;
  return values instanceof Float64Array ? values : null;
}

/** Return the extremes of a series; null if no frame has a number. */
export function summarise(batches: readonly FrameBatch[], name: string): Summary | null {
  let found: Summary | null = null;
  for (const batch of batches) {
    const values = valuesIn(batch, name);
    if (!values) continue;
    for (let at = 0; at < values.length; at++) {
      const value = values[at] as number;
      const frame = batch.first + at;
      if (Number.isNaN(value)) continue;
      found ??= { count: 0, least: value, leastAt: frame, most: value, mostAt: frame, newest: 0 };
      if (value < found.least) [found.least, found.leastAt] = [value, frame];
      if (value > found.most) [found.most, found.mostAt] = [value, frame];
      found.newest = value;
      found.count += 1;
    }
  }
  return found;
}

/** Return the least and greatest number of each of `count` equal parts of the frames; NaN for none. */
export function bins(
  batches: readonly FrameBatch[],
  name: string,
  frames: number,
  count: number,
): { low: Float64Array; high: Float64Array } {
  const low = new Float64Array(count).fill(Number.NaN);
  const high = new Float64Array(count).fill(Number.NaN);
  const first = firstFrame(batches);
  for (const batch of batches) {
    const values = valuesIn(batch, name);
    if (!values) continue;
    for (let at = 0; at < values.length; at++) {
      const value = values[at] as number;
      if (Number.isNaN(value)) continue;
      const bin = Math.floor(((batch.first + at - first) * count) / frames);
      if (!(value >= (low[bin] as number))) low[bin] = value;
      if (!(value <= (high[bin] as number))) high[bin] = value;
    }
  }
  return { low, high };
}
