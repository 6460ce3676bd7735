/** Pictures in the fragments of an MP4, as cameras and browsers record it. */

import { boxes, find } from "./mp4";

/** A picture's place in the file, and its time in ticks. */
export interface Place {
  at: number;
  length: number;
  time: number;
  key: boolean;
}

/** Flags of headers: which values follow. */
const [BASE, DESCRIPTION, DURATION, SIZE, FLAGS] = [1, 2, 8, 0x10, 0x20];
const [OFFSET, FIRST_FLAGS, EACH_DURATION, EACH_SIZE, EACH_FLAGS, EACH_SHIFT] = [
  ...[1, 4, 0x100, 0x200],
  ...[0x400, 0x800],
] as [number, number, number, number, number, number];
const NO_KEY = 0x10000;

/** Read the pictures of a track in a fragment that begins at `start`. */
export function fragmentSamples(
  fragment: DataView,
  start: number,
  track: number,
  defaults: DataView | null,
  before: Place[],
): Place[] {
  const common = defaults
    ? boxes(defaults).find(({ kind, view }) => kind === "trex" && view.getUint32(4) === track)?.view
    : undefined;
  const places: Place[] = [];
  for (const { kind, view } of boxes(fragment)) {
    const header = kind === "traf" ? find(view, "tfhd") : null;
    if (!header || header.getUint32(4) !== track) continue;
    const flags = header.getUint32(0) & 0xffffff;
    let at = 8;
    const next = (flag: number, otherwise: number): number => {
      if (!(flags & flag)) return otherwise;
      at += 4;
      return header.getUint32(at - 4);
    };
    let base = start;
    if (flags & BASE) {
      base = Number(header.getBigUint64(at));
      at += 8;
    }
    next(DESCRIPTION, 0);
    const duration = next(DURATION, common?.getUint32(12) ?? 0);
    const size = next(SIZE, common?.getUint32(16) ?? 0);
    const usual = next(FLAGS, common?.getUint32(20) ?? 0);
    const decode = find(view, "tfdt");
    const last = before.at(-1);
    let time = last ? last.time + duration : 0;
    if (decode) time = decode.getUint8(0) ? Number(decode.getBigUint64(4)) : decode.getUint32(4);
    let place = base;
    for (const run of boxes(view)) {
      if (run.kind !== "trun") continue;
      [place, time] = readRun(run.view, base, place, time, { duration, size, usual }, places);
    }
  }
  return places;
}

function readRun(
  run: DataView,
  base: number,
  from: number,
  begin: number,
  { duration, size, usual }: { duration: number; size: number; usual: number },
  places: Place[],
): [number, number] {
  const flags = run.getUint32(0) & 0xffffff;
  const count = run.getUint32(4);
  let [at, place, time] = [8, from, begin];
  if (flags & OFFSET) {
    place = base + run.getInt32(at);
    at += 4;
  }
  let first = usual;
  if (flags & FIRST_FLAGS) {
    first = run.getUint32(at);
    at += 4;
  }
  const next = (flag: number, otherwise: number): number => {
    if (!(flags & flag)) return otherwise;
    at += 4;
    return run.getUint32(at - 4);
  };
  for (let index = 0; index < count; index++) {
    const lasts = next(EACH_DURATION, duration);
    const length = next(EACH_SIZE, size);
    const kind = next(EACH_FLAGS, index === 0 ? first : usual);
    const shift = next(EACH_SHIFT, 0) | 0;
    places.push({ at: place, length, time: time + shift, key: !(kind & NO_KEY) });
    place += length;
    time += lasts;
  }
  return [place, time];
}
