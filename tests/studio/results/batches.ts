/** Makes the batches of a run out of its JSON document, as the chip would have sent them. */

import type {
  Clip,
  FrameBatch,
  FrameDocument,
  OutputColumn,
  ProgramInfo,
  RunDocument,
} from "../../../src/npchip/studio/page/protocol";

/** A run with its clip, as `runs.py` writes it. */
export interface Recorded {
  program: ProgramInfo;
  document: RunDocument;
  clip: number[][];
  /** Cycles by address of the whole run. */
  profile: number[];
}

/** Return the run in batches of `size` frames. */
export function batchesOf({ program, document, clip }: Recorded, size: number): FrameBatch[] {
  const batches: FrameBatch[] = [];
  const { frames } = document;
  for (let first = 0; first < Math.max(1, frames.length); first += size) {
    const part = frames.slice(first, first + size);
    batches.push({
      first,
      cycles: Float64Array.from(part, (frame) => frame.cycles),
      instructions: Float64Array.from(part, (frame) => frame.instructions),
      outputs: columns(program, part),
      frames: Uint8Array.from(clip.slice(first, first + part.length).flat()),
      ...(first ? {} : { setup: document.setup }),
    });
  }
  return batches;
}

/** Return the clip of a run. */
export function clipOf({ program, clip }: Recorded): Clip {
  const { np_rows, np_cols } = program.machine;
  const data = Uint8Array.from(clip.flat());
  const size = { rows: 8 * np_rows, cols: 8 * np_cols };
  return { name: "clip", count: clip.length, ...size, data, fps: null };
}

function columns(program: ProgramInfo, part: FrameDocument[]): Record<string, OutputColumn> {
  const sides = program.machine;
  const columns: Record<string, OutputColumn> = {};
  const kinds = new Map(program.outputs.map((output) => [output.name, output.kind]));
  for (const name of Object.keys(part[0]?.outputs ?? {})) {
    const kind = kinds.get(name) ?? "plane";
    const values = part.map((frame) => frame.outputs[name] ?? null);
    if (kind === "list") {
      columns[name] = { kind, values: values as (number[] | null)[] };
    } else if (kind === "plane" || kind === "picture") {
      const side = kind === "picture" ? 8 : 1;
      const planes = values.map((value) => (value === null ? null : Uint8Array.from((value as number[][]).flat())));
      const [rows, cols] = [side * sides.np_rows, side * sides.np_cols];
      columns[name] = { kind, rows, cols, values: planes };
    } else {
      columns[name] = { kind, values: Float64Array.from(values, (value) => (value as number) ?? NaN) };
    }
  }
  return columns;
}
