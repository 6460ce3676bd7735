/** What a container says of its first video track. */

/** How a picture is turned before it is shown. */
export interface Turn {
  exchange: boolean;
  flipped: boolean;
  mirrored: boolean;
}

/** A packed picture. */
export interface Sample {
  data: Uint8Array<ArrayBuffer>;
  /** Microseconds. */
  time: number;
  key: boolean;
}

export interface Track {
  /** As WebCodecs names it; null for what browsers have no decoder for. */
  codec: string | null;
  /** As the file names it. */
  written: string;
  description: Uint8Array<ArrayBuffer> | null;
  rows: number;
  cols: number;
  turn: Turn | null;
  /** Number of the matrix of its colours (ISO 23091-2), as the container declares it. */
  matrix: number | null;
  /** Microseconds from which on, and up to which, pictures are shown. */
  from: number;
  to: number;
  /** Number of samples if known. */
  count: number | null;
  samples(): AsyncIterable<Sample>;
}

/** Return the name of H.264 from its configuration. */
export function avcName(config: Uint8Array): string {
  return `avc1.${hex(config[1])}${hex(config[2])}${hex(config[3])}`;
}

/** Return the name of H.265 from its configuration. */
export function hevcName(config: Uint8Array): string {
  const view = new DataView(config.buffer, config.byteOffset, config.length);
  const first = config[1] ?? 0;
  let compatible = view.getUint32(2);
  let reversed = 0;
  for (let bit = 0; bit < 32; bit++, compatible >>>= 1) reversed = (reversed << 1) | (compatible & 1);
  const constraints = [...config.subarray(6, 12)].map(hex);
  while (constraints.at(-1) === "00") constraints.pop();
  const space = ["", "A", "B", "C"][first >> 6]!;
  const tier = first & 0x20 ? "H" : "L";
  const parts = [`hev1`, `${space}${first & 31}`, (reversed >>> 0).toString(16), `${tier}${config[12]}`];
  return [...parts, ...constraints].join(".");
}

/** Return the name of AV1 from its configuration. */
export function av1Name(config: Uint8Array): string {
  const [one, two] = [config[1] ?? 0, config[2] ?? 0];
  const depth = two & 0x40 ? (two & 0x20 ? 12 : 10) : 8;
  return `av01.${one >> 5}.${twoDigits(one & 31)}${two & 0x80 ? "H" : "M"}.${twoDigits(depth)}`;
}

/** Return the name of VP9 of a profile; its level does not matter to decoders. */
export function vp9Name(profile: number, depth: number): string {
  return `vp09.${twoDigits(profile)}.10.${twoDigits(depth)}`;
}

function hex(byte: number | undefined): string {
  return (byte ?? 0).toString(16).padStart(2, "0");
}

function twoDigits(value: number): string {
  return String(value).padStart(2, "0");
}
