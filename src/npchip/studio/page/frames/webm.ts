/** The first video track of a WebM or Matroska file. */

import { text } from "./bytes";
import { parameters } from "./declared";
import { damaged, FramesError, notHere } from "./errors";
import type { Region } from "./region";
import { av1Name, avcName, hevcName, type Sample, type Track, vp9Name } from "./track";

/** Numbers of elements. */
const [SEGMENT, INFO, TRACKS, CLUSTER] = [0x18538067, 0x1549a966, 0x1654ae6b, 0x1f43b675];
const [SCALE, ENTRY, NUMBER, TYPE, CODEC, PRIVATE] = [0x2ad7b1, 0xae, 0xd7, 0x83, 0x86, 0x63a2];
const [VIDEO, WIDTH, HEIGHT, ALPHA, ENCODINGS] = [0xe0, 0xb0, 0xba, 0x53c0, 0x6d80];
const [COLOUR, MATRIX] = [0x55b0, 0x55b1];
const [TIME, SIMPLE, GROUP, BLOCK, REFERENCE] = [0xe7, 0xa3, 0xa0, 0xa1, 0xfb];
const ADDITIONS = 0x75a1;
const [IS_VIDEO, LACED, IS_KEY] = [1, 0x06, 0x80];
const LONGEST = 1 << 26;

interface Element {
  id: number;
  start: number;
  /** Place behind it; null if the file does not tell, as from a live stream. */
  end: number | null;
}

/** Read the description of a file's video. */
export async function openWebm(region: Region): Promise<Track> {
  const { name } = region;
  let [scale, at, end] = [1e6, 0, region.size];
  while (at < end) {
    const element = await elementAt(region, at, end);
    if (element.id === SEGMENT) {
      at = element.start;
      end = element.end ?? region.size;
      if (end > region.size) throw region.cut(end);
      continue;
    }
    if (element.id === CLUSTER || element.end === null) break;
    if (element.id === INFO || element.id === TRACKS) {
      const inside = children(await content(region, element));
      if (element.id === INFO) {
        const found = inside.get(SCALE)?.[0];
        scale = found ? unsigned(found) || 1e6 : 1e6;
      } else {
        const video = (inside.get(ENTRY) ?? [])
          .map(children)
          .find((entry) => unsigned(entry.get(TYPE)?.[0]) === IS_VIDEO);
        if (!video) break;
        return describe(region, video, scale, element.end, end);
      }
    }
    at = element.end;
  }
  const help = "Choose a file with a video";
  throw new FramesError("NP227", `${name}: holds no video, only other streams`, help);
}

async function describe(
  region: Region,
  entry: Map<number, Uint8Array<ArrayBuffer>[]>,
  scale: number,
  from: number,
  end: number,
): Promise<Track> {
  const { name } = region;
  if (entry.has(ENCODINGS)) {
    throw notHere(name, "a video whose packets are packed once more", "Let a video editor save it anew");
  }
  const written = text(entry.get(CODEC)?.[0] ?? new Uint8Array(0)).replace(/\0+$/, "");
  const config = entry.get(PRIVATE)?.[0] ?? null;
  const video = children(entry.get(VIDEO)?.[0] ?? new Uint8Array(0));
  const number = unsigned(entry.get(NUMBER)?.[0]);
  const colour = children(video.get(COLOUR)?.[0] ?? new Uint8Array(0));
  const alpha = unsigned(video.get(ALPHA)?.[0]) === 1;
  const samples = (): AsyncGenerator<Sample> => blocks(region, number, alpha, scale, from, end);
  const described = { written, description: null as Uint8Array<ArrayBuffer> | null };
  let codec: string | null = null;
  if (written === "V_VP8") codec = "vp8";
  else if (written === "V_VP9") codec = await vp9(samples());
  else if (written === "V_AV1" && config) codec = av1Name(config);
  else if (written === "V_MPEG4/ISO/AVC") codec = config ? avcName(config) : await avc(samples());
  else if (written === "V_MPEGH/ISO/HEVC" && config) codec = hevcName(config);
  if (written.startsWith("V_MPEG")) described.description = config;
  return {
    ...described,
    codec,
    rows: unsigned(video.get(HEIGHT)?.[0]),
    cols: unsigned(video.get(WIDTH)?.[0]),
    turn: null,
    matrix: colour.has(MATRIX) ? unsigned(colour.get(MATRIX)?.[0]) : null,
    from: Number.NEGATIVE_INFINITY,
    to: Number.POSITIVE_INFINITY,
    count: null,
    samples,
  };
}

/** Read the profile of VP9 from its first picture, as the container need not tell. */
async function vp9(samples: AsyncIterable<Sample>): Promise<string> {
  for await (const { data } of samples) {
    const first = data[0] ?? 0;
    const profile = ((first >> 5) & 1) | ((first >> 3) & 2);
    const twelve = profile >= 2 && ((data[4] ?? 0) & 0x80) !== 0;
    return vp9Name(profile, profile < 2 ? 8 : twelve ? 12 : 10);
  }
  return vp9Name(0, 8);
}

/** Read the name of H.264 from its first picture, where the container has no configuration. */
async function avc(samples: AsyncIterable<Sample>): Promise<string | null> {
  for await (const { data } of samples) {
    const config = parameters(data);
    return config && avcName(config);
  }
  return null;
}

/** Yield the packed pictures of a track. */
async function* blocks(
  region: Region,
  track: number,
  alpha: boolean,
  scale: number,
  from: number,
  end: number,
): AsyncGenerator<Sample> {
  const { name } = region;
  const open = [CLUSTER, GROUP]; // what is gone into
  let [at, time, group, referring] = [from, 0, 0, false];
  let held: Sample | null = null; // a block of a group, until it is known whether it is a key
  while (at < end) {
    const element = await elementAt(region, at, end);
    if (held && at >= group) {
      yield { ...held, key: !referring };
      held = null;
    }
    if (open.includes(element.id)) {
      if (element.end !== null && element.end > region.size) throw region.cut(element.end);
      if (element.id === GROUP) [group, referring] = [element.end ?? end, false];
      at = element.start;
      continue;
    }
    if (element.end === null) throw damaged(name, "a part of it has no length");
    if (element.end > region.size) throw region.cut(element.end);
    if (element.id === TIME) time = unsigned(await content(region, element));
    if (element.id === REFERENCE) referring = true;
    // Browsers say of what they record that it may be transparent; it is only if this follows.
    if (element.id === ADDITIONS && alpha && held) {
      const help = "Convert it to one without: ffmpeg -i FILE -c:v libvpx-vp9 -pix_fmt yuv420p OTHER.webm";
      throw notHere(name, "a video with transparent parts, which browsers leave out", help);
    }
    if (element.id === SIMPLE || element.id === BLOCK) {
      const sample = blockOf(await content(region, element), track, time, scale, name);
      if (sample && element.id === SIMPLE) yield sample;
      else if (sample) held = sample;
    }
    at = element.end;
  }
  if (held) yield { ...held, key: !referring };
}

function blockOf(
  data: Uint8Array<ArrayBuffer>,
  track: number,
  time: number,
  scale: number,
  name: string,
): Sample | null {
  const width = Math.clz32(data[0] ?? 0) - 23;
  if (data.length < width + 3) throw damaged(name, "a picture of it is cut short");
  if (variable(data, 0, width) !== track) return null;
  const shift = new DataView(data.buffer, data.byteOffset + width, 2).getInt16(0);
  const flags = data[width + 2]!;
  if (flags & LACED) throw notHere(name, "a video with several pictures in a packet", "Save it anew");
  return {
    data: data.subarray(width + 3),
    time: Math.round(((time + shift) * scale) / 1000),
    key: (flags & IS_KEY) !== 0,
  };
}

async function elementAt(region: Region, at: number, end: number): Promise<Element> {
  const head = await region.read(at, Math.min(12, region.size - at));
  const width = Math.clz32(head[0] ?? 0) - 23;
  const wide = Math.clz32(head[width] ?? 0) - 23;
  if (at + width + 1 > Math.min(end, region.size) || head.length < width + wide) {
    throw region.cut(at + Math.max(width + wide, 2));
  }
  if (width > 4 || wide > 8) throw damaged(region.name, "a part of it has no number");
  const id = head.subarray(0, width).reduce((sum, byte) => sum * 256 + byte, 0);
  const length = variable(head, width, wide);
  const start = at + width + wide;
  return { id, start, end: length === 2 ** (7 * wide) - 1 ? null : start + length };
}

/** Read a number that tells its own width. */
function variable(data: Uint8Array, at: number, width: number): number {
  let value = data[at]! & (0xff >> width);
  for (let byte = 1; byte < width; byte++) value = value * 256 + data[at + byte]!;
  return value;
}

async function content(region: Region, { start, end }: Element): Promise<Uint8Array<ArrayBuffer>> {
  const length = (end ?? start) - start;
  if (length > LONGEST) throw damaged(region.name, `a part of ${length} bytes is too long`);
  return region.read(start, length);
}

/** Split an element into what is in it, by number. */
function children(data: Uint8Array<ArrayBuffer>): Map<number, Uint8Array<ArrayBuffer>[]> {
  const found = new Map<number, Uint8Array<ArrayBuffer>[]>();
  for (let at = 0; at < data.length; ) {
    const width = Math.clz32(data[at]!) - 23;
    const wide = Math.clz32(data[at + width] ?? 0) - 23;
    if (width > 4 || wide > 8 || at + width + wide > data.length) break;
    const id = data.subarray(at, at + width).reduce((sum, byte) => sum * 256 + byte, 0);
    const start = at + width + wide;
    at = start + variable(data, at + width, wide);
    found.set(id, [...(found.get(id) ?? []), data.subarray(start, at)]);
  }
  return found;
}

function unsigned(data: Uint8Array | undefined): number {
  return (data ?? new Uint8Array(0)).reduce((sum, byte) => sum * 256 + byte, 0);
}
