/**
 * The matrix that a stream declares for its colours, by the numbers of ISO 23091-2.
 *
 * It is asked for because npchip takes a stream's own luma, unless a matrix other than ITU-R 601 is
 * declared: then PyAV makes colours by it and 601's luma of these. The page must do likewise.
 */

import { Bits } from "./bits";
import type { Track } from "./track";

const [BT709, UNKNOWN, BT470, BT601] = [1, 2, 5, 6];

/** What a stream declares of its colours. */
export interface Declared {
  matrix: number;
  /** True if values take all of the range, null if the decoder must tell. */
  full: boolean | null;
}

/** Numbers of VP9's own. */
const VP9 = [UNKNOWN, BT470, BT709, BT601, 7, 9, UNKNOWN, 0];
const SYNC = 0x498342;

/**
 * Return what a stream declares, from its first packet and what the container says.
 *
 * A packet of VP9 that declares none is changed to declare ITU-R 601: Firefox hands out colours
 * only, and their luma comes back if it is known how they were made. The stored luma stays.
 */
export function declaredColours(track: Track, packet: Uint8Array): Declared {
  const { codec } = track;
  if (codec === "vp8") return { matrix: BT470, full: null };
  if (codec?.startsWith("vp09")) return vp9Colours(packet);
  if (codec?.startsWith("av01")) return av1Colours(packet);
  const config = track.description ?? parameters(packet);
  const inside = codec?.startsWith("avc1") && config ? h264Matrix(config) : null;
  return { matrix: inside ?? track.matrix ?? UNKNOWN, full: null };
}

/** Read what a packet of VP9 declares, and declare a matrix if there is none. */
export function vp9Colours(packet: Uint8Array): Declared {
  const none = { matrix: UNKNOWN, full: null };
  const bits = new Bits(packet);
  if (bits.read(2) !== 2) return none;
  const profile = bits.read(1) | (bits.read(1) << 1);
  if (profile === 3) bits.read(1);
  if (bits.flag()) return none; // shows a picture that was decoded before
  if (bits.flag()) return none; // no key frame
  bits.read(2);
  if (bits.read(24) !== SYNC) return none;
  if (profile >= 2) bits.read(1); // depth
  const space = bits.read(3);
  if (space === 0) {
    bits.at -= 3;
    bits.write(3, 1);
  }
  return { matrix: VP9[space]!, full: space === 7 ? null : bits.flag() };
}

/** Read what the sequence header in a packet of AV1 declares. */
export function av1Colours(packet: Uint8Array): Declared {
  for (let at = 0; at < packet.length; ) {
    const head = packet[at]!;
    const [kind, extended, sized] = [(head >> 3) & 15, head & 4, head & 2];
    at += extended ? 2 : 1;
    let length = packet.length - at;
    if (sized) {
      length = 0;
      for (let byte = 0; byte < 8; byte++) {
        const next = packet[at++] ?? 0;
        length += (next & 127) * 2 ** (7 * byte);
        if (!(next & 128)) break;
      }
    }
    if (kind === 1) return sequenceColours(new Bits(packet.subarray(at, at + length)));
    at += length;
  }
  return { matrix: UNKNOWN, full: null };
}

function sequenceColours(bits: Bits): Declared {
  const profile = bits.read(3);
  bits.read(1);
  const reduced = bits.flag();
  if (reduced) bits.read(5);
  else {
    if (bits.flag()) return { matrix: UNKNOWN, full: null }; // timing, which files do not hold
    const delays = bits.flag();
    for (let points = bits.read(5) + 1; points > 0; points--) {
      bits.read(12);
      if (bits.read(5) > 7) bits.read(1);
      if (delays && bits.flag()) bits.read(4);
    }
  }
  const [width, height] = [bits.read(4) + 1, bits.read(4) + 1];
  bits.read(width + height);
  if (!reduced && bits.flag()) bits.read(7); // numbers of frames
  bits.read(3);
  if (!reduced) {
    bits.read(4);
    const hinted = bits.flag();
    if (hinted) bits.read(2);
    const chosen = bits.flag() ? 2 : bits.read(1); // screen content
    if (chosen > 0 && !bits.flag()) bits.read(1);
    if (hinted) bits.read(3);
  }
  bits.read(3);
  const deep = bits.flag();
  if (profile === 2 && deep) bits.read(1);
  const grey = profile !== 1 && bits.flag();
  let matrix = UNKNOWN;
  if (bits.flag()) {
    bits.read(16);
    matrix = bits.read(8);
  }
  return { matrix, full: matrix === 0 && !grey ? null : bits.flag() };
}

/**
 * Return the parameters of H.264 in a packet as a configuration has them; null if there are none.
 * Files of browsers have no configuration, but packets that begin with what is needed.
 */
export function parameters(packet: Uint8Array): Uint8Array<ArrayBuffer> | null {
  for (let at = 0; at + 8 < packet.length; at++) {
    const mark = packet[at] === 0 && packet[at + 1] === 0 && packet[at + 2] === 1;
    if (!mark || (packet[at + 3]! & 31) !== 7) continue;
    let end = at + 4;
    while (end < packet.length && (packet[end] !== 0 || packet[end + 1] !== 0)) end++;
    const stored = packet.subarray(at + 3, end);
    const head = [1, ...stored.subarray(1, 4), 0xff, 0xe1, stored.length >> 8, stored.length & 255];
    return Uint8Array.from([...head, ...stored]);
  }
  return null;
}

/** Profiles of H.264 that state their kinds of colours. */
const HIGH = [100, 110, 122, 244, 44, 83, 86, 118, 128, 138, 139, 134, 135];

/** Read the matrix in the configuration of H.264; null if there is none. */
export function h264Matrix(config: Uint8Array): number | null {
  const length = ((config[6] ?? 0) << 8) | (config[7] ?? 0);
  if (((config[5] ?? 0) & 31) === 0) return null;
  const stored = config.subarray(8, 8 + length);
  const plain = stored.filter((byte, at) => byte !== 3 || stored[at - 1] !== 0 || stored[at - 2] !== 0);
  const bits = new Bits(plain);
  bits.read(8);
  const profile = bits.read(8);
  bits.read(16);
  bits.golomb();
  if (HIGH.includes(profile)) {
    const kind = bits.golomb();
    if (kind === 3) bits.read(1);
    bits.golomb();
    bits.golomb();
    bits.read(1);
    if (bits.flag()) for (let list = 0; list < (kind === 3 ? 12 : 8); list++) skipScaling(bits, list);
  }
  bits.golomb();
  const order = bits.golomb();
  if (order === 0) bits.golomb();
  else if (order === 1) {
    bits.read(1);
    bits.golomb();
    bits.golomb();
    for (let left = Math.min(bits.golomb(), 255); left > 0; left--) bits.golomb();
  }
  bits.golomb();
  bits.read(1);
  bits.golomb();
  bits.golomb();
  if (!bits.flag()) bits.read(1);
  bits.read(1);
  if (bits.flag()) for (let side = 0; side < 4; side++) bits.golomb(); // what is cut off
  if (!bits.flag()) return null;
  if (bits.flag() && bits.read(8) === 255) bits.read(32); // shape of pixels
  if (bits.flag()) bits.read(1);
  if (!bits.flag()) return null;
  bits.read(4);
  if (!bits.flag()) return null;
  bits.read(16);
  return bits.read(8);
}

function skipScaling(bits: Bits, list: number): void {
  if (!bits.flag()) return;
  let [last, next] = [8, 8];
  for (let left = list < 6 ? 16 : 64; left > 0; left--) {
    if (next !== 0) next = (last + bits.golomb(true) + 256) % 256;
    last = next === 0 ? last : next;
  }
}
