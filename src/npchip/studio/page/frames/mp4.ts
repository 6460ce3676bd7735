/** The first video track of an MP4 or MOV file, whole or in fragments. */

import { standsAt, text } from "./bytes";
import { damaged, FramesError, notHere } from "./errors";
import { fragmentSamples, type Place } from "./mp4fragments";
import type { Region } from "./region";
import { av1Name, avcName, hevcName, type Sample, type Track, type Turn, vp9Name } from "./track";

/** A box: its kind and what is in it. */
export interface Box {
  kind: string;
  view: DataView;
}

/** Longest list of tables that is taken into memory. */
const LONGEST = 1 << 26;

/** Read the tables of a file. */
export async function openMp4(region: Region): Promise<Track> {
  const { name } = region;
  let tables: DataView | null = null;
  const fragments: { start: number; view: DataView }[] = [];
  let at = 0;
  while (region.size - at >= 8) {
    const head = new DataView((await region.read(at, 8)).buffer);
    const kind = text(new Uint8Array(head.buffer, 4, 4));
    if (!/^[\w ]{4}$/.test(kind)) break; // bytes behind the last box
    let [length, start] = [head.getUint32(0), 8];
    if (length === 1) {
      length = Number(new DataView((await region.read(at + 8, 8)).buffer).getBigUint64(0));
      start = 16;
    } else if (length === 0) length = region.size - at;
    if (length < start) throw damaged(name, `a part '${kind}' has a wrong length`);
    if (at + length > region.size) throw region.cut(at + length);
    if (kind === "moov" || kind === "moof") {
      if (length > LONGEST) throw damaged(name, `a part '${kind}' of ${length} bytes is too long`);
      const view = new DataView((await region.read(at + start, length - start)).buffer);
      if (kind === "moov") tables ??= view;
      else fragments.push({ start: at, view });
    }
    at += length;
  }
  if (!tables) throw damaged(name, "it has no table of its pictures; it may be cut short");
  if (at < region.size && find(tables, "mvex")) {
    throw damaged(name, `the part of it at byte ${at} cannot be read`); // pictures may follow
  }
  const track = boxes(tables).find((box) => box.kind === "trak" && isVideo(box.view));
  if (!track) {
    const help = "Choose a file with a video";
    throw new FramesError("NP227", `${name}: holds no video, only other streams`, help);
  }
  return describe(region, tables, track.view, fragments);
}

/** Split the content of a box into boxes; damage ends them. */
export function boxes(view: DataView, from = 0): Box[] {
  const found: Box[] = [];
  for (let at = from; at + 8 <= view.byteLength; ) {
    let [length, start] = [view.getUint32(at), 8];
    if (length === 1 && at + 16 <= view.byteLength) {
      length = Number(view.getBigUint64(at + 8));
      start = 16;
    } else if (length === 0) length = view.byteLength - at;
    if (length < start || at + length > view.byteLength) break;
    const kind = text(new Uint8Array(view.buffer, view.byteOffset + at + 4, 4));
    found.push({
      kind,
      view: new DataView(view.buffer, view.byteOffset + at + start, length - start),
    });
    at += length;
  }
  return found;
}

/** Return a box by the way to it; null if there is none. */
export function find(view: DataView, way: string): DataView | null {
  let found: DataView | null = view;
  for (const kind of way.split("/")) {
    found = (found && boxes(found).find((box) => box.kind === kind)?.view) ?? null;
  }
  return found;
}

function isVideo(track: DataView): boolean {
  const handler = find(track, "mdia/hdlr");
  return handler !== null && standsAt(bytesOf(handler), 8, "vide");
}

export function bytesOf(view: DataView): Uint8Array<ArrayBuffer> {
  return new Uint8Array(view.buffer as ArrayBuffer, view.byteOffset, view.byteLength);
}

function describe(
  region: Region,
  tables: DataView,
  track: DataView,
  fragments: { start: number; view: DataView }[],
): Track {
  const { name } = region;
  const [header, media, stored] = ["tkhd", "mdia/mdhd", "mdia/minf/stbl"].map((way) => find(track, way));
  const entry = stored && find(stored, "stsd");
  if (!header || !media || !stored || !entry) throw damaged(name, "its tables lack a part");
  const first = boxes(entry, 8)[0];
  if (!first || first.view.byteLength < 78) throw damaged(name, "its video is not described");
  const scale = media.getUint32(media.getUint8(0) ? 20 : 12) || 1;
  const number = header.getUint32(header.getUint8(0) ? 20 : 12);
  const places = samplePlaces(stored, name);
  for (const { start, view } of fragments) {
    places.push(...fragmentSamples(view, start, number, find(tables, "mvex"), places));
  }
  const micro = (ticks: number): number => Math.round((1e6 * ticks) / scale);
  const [from, to] = edit(track, tables, scale, name);
  async function* samples(): AsyncGenerator<Sample> {
    for (const { at, length, time, key } of places) {
      yield { data: await region.read(at, length), time: micro(time), key };
    }
  }
  return {
    ...coding(first, name),
    rows: first.view.getUint16(26),
    cols: first.view.getUint16(24),
    turn: turnOf(header, name),
    matrix: matrixOf(first.view),
    from: from === null ? Number.NEGATIVE_INFINITY : micro(from),
    to: to === null ? Number.POSITIVE_INFINITY : micro(to),
    count: places.length,
    samples,
  };
}

/** Return the decoder of a video and its configuration. */
function coding({ kind, view }: Box, name: string): Pick<Track, "codec" | "written" | "description"> {
  const inside = (wanted: string): Uint8Array<ArrayBuffer> => {
    const box = boxes(view, 78).find((one) => one.kind === wanted);
    if (!box || box.view.byteLength < 8) throw damaged(name, "its video is not described");
    return bytesOf(box.view);
  };
  const written = kind;
  if (kind === "avc1" || kind === "avc3") {
    const description = inside("avcC");
    return { codec: avcName(description), written, description };
  }
  if (kind === "hvc1" || kind === "hev1") {
    const description = inside("hvcC");
    return { codec: hevcName(description), written, description };
  }
  if (kind === "vp08") return { codec: "vp8", written, description: null };
  if (kind === "vp09") {
    const config = inside("vpcC");
    return { codec: vp9Name(config[4]!, config[6]! >> 4), written, description: null };
  }
  if (kind === "av01") return { codec: av1Name(inside("av1C")), written, description: null };
  if (kind === "encv") throw notHere(name, "a video under encryption", "Choose one without");
  return { codec: null, written, description: null };
}

function matrixOf(entry: DataView): number | null {
  const colours = boxes(entry, 78).find(({ kind }) => kind === "colr")?.view;
  const declared = colours && colours.byteLength >= 10 && /^ncl[xc]/.test(text(bytesOf(colours)));
  return declared ? colours.getUint16(8) : null;
}

/** Read how a picture is turned: x' = ax + cy, y' = bx + dy. */
function turnOf(header: DataView, name: string): Turn | null {
  const at = header.getUint8(0) ? 52 : 40;
  const [a, b, c, d] = [0, 4, 12, 16].map((place) => header.getInt32(at + place)) as [
    ...[number, number],
    ...[number, number],
  ];
  if (a && d && !b && !c) {
    return a > 0 && d > 0 ? null : { exchange: false, flipped: d < 0, mirrored: a < 0 };
  }
  if (b && c && !a && !d) return { exchange: true, flipped: c < 0, mirrored: b < 0 };
  if (!a && !b && !c && !d) return null;
  throw new FramesError(
    "NP228",
    `${name}: expected an orientation in steps of 90 degrees, found another angle`,
    "Let a video editor turn it, and save it without a display matrix",
  );
}

/** Return the times, in ticks, between which pictures are shown. */
function edit(
  track: DataView,
  tables: DataView,
  scale: number,
  name: string,
): [number | null, number | null] {
  const list = find(track, "edts/elst");
  const movie = find(tables, "mvhd");
  if (!list || !movie) return [null, null];
  const long = list.getUint8(0) === 1;
  const entries: { length: number; start: number }[] = [];
  for (let index = 0; index < list.getUint32(4); index++) {
    const at = 8 + index * (long ? 20 : 12);
    const length = long ? Number(list.getBigUint64(at)) : list.getUint32(at);
    const start = long ? Number(list.getBigInt64(at + 8)) : list.getInt32(at + 4);
    if (start >= 0) entries.push({ length, start }); // others are pauses
  }
  if (entries.length > 1) {
    throw notHere(name, "a video with a list of cuts", "Let a video editor save it anew");
  }
  const [only] = entries;
  if (!only) return [null, null];
  const movieScale = movie.getUint32(movie.getUint8(0) ? 20 : 12) || 1;
  const ticks = Math.ceil((only.length * scale) / movieScale);
  return [only.start, only.length ? only.start + ticks : null];
}

/** Read where each picture lies in the file, and when it is shown. */
function samplePlaces(stored: DataView, name: string): Place[] {
  const table = (kind: string): DataView | null => find(stored, kind);
  const [sizes, chunks, times] = [table("stsz"), table("stsc"), table("stts")];
  const [short, long] = [table("stco"), table("co64")];
  if (!sizes || !chunks || !times || !(short || long)) throw damaged(name, "its tables lack a part");
  const count = sizes.getUint32(8);
  const same = sizes.getUint32(4);
  if (!same && 12 + 4 * count > sizes.byteLength) throw damaged(name, "its tables are cut short");
  const shifts = table("ctts");
  const keys = table("stss");
  const starts = new Set<number>();
  for (let index = 0; keys && index < keys.getUint32(4); index++) {
    starts.add(keys.getUint32(8 + 4 * index) - 1);
  }
  const offsets = short ?? long!;
  const step = runs(times, 8, false);
  const shift = shifts ? runs(shifts, 8, true) : (): number => 0;
  const places: Place[] = [];
  let [chunk, rest, at, row, time] = [-1, 0, 0, -1, 0];
  for (let index = 0; index < count; index++) {
    while (rest === 0) {
      chunk++;
      if (chunk >= offsets.getUint32(4)) throw damaged(name, "its tables do not fit together");
      at = short ? short.getUint32(8 + 4 * chunk) : Number(long!.getBigUint64(8 + 8 * chunk));
      const rows = chunks.getUint32(4);
      while (row + 1 < rows && chunks.getUint32(8 + 12 * (row + 1)) <= chunk + 1) row++;
      rest = chunks.getUint32(12 + 12 * Math.max(row, 0));
    }
    const length = same || sizes.getUint32(12 + 4 * index);
    places.push({ at, length, time: time + shift(), key: !keys || starts.has(index) });
    at += length;
    time += step();
    rest--;
  }
  return places;
}

/** Return what gives one value after the other of a table of counts and values. */
function runs(table: DataView, at: number, signed: boolean): () => number {
  let [left, value] = [0, 0];
  return () => {
    while (left === 0 && at + 8 <= table.byteLength) {
      left = table.getUint32(at);
      value = signed ? table.getInt32(at + 4) : table.getUint32(at + 4);
      at += 8;
    }
    left--;
    return value;
  };
}
