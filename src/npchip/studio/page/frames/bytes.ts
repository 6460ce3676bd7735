/** Reading files: numbers in either byte order, checksums, packed data. */

import { damaged } from "./errors";

/** Bytes that are read one after the other. */
export class Bytes {
  readonly view: DataView;

  constructor(
    readonly data: Uint8Array<ArrayBuffer>,
    public at = 0,
  ) {
    this.view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  }

  get left(): number {
    return this.data.length - this.at;
  }

  /** Return the next bytes without a copy; null if there are not as many. */
  take(count: number): Uint8Array<ArrayBuffer> | null {
    if (count > this.left) return null;
    this.at += count;
    return this.data.subarray(this.at - count, this.at);
  }
}

/** Return bytes as text, a character each. */
export function text(data: Uint8Array): string {
  return String.fromCharCode(...data);
}

/** Tell whether text stands at a place. */
export function standsAt(data: Uint8Array, at: number, wanted: string): boolean {
  return data.length >= at + wanted.length && text(data.subarray(at, at + wanted.length)) === wanted;
}

const TABLE = new Uint32Array(256).map((_, start) => {
  let rest = start;
  for (let bit = 0; bit < 8; bit++) rest = rest & 1 ? (rest >>> 1) ^ 0xedb88320 : rest >>> 1;
  return rest;
});

/** Return the CRC-32 of bytes. */
export function crc32(data: Uint8Array): number {
  let crc = 0xffffffff;
  for (let at = 0; at < data.length; at++) crc = (crc >>> 8) ^ TABLE[(crc ^ data[at]!) & 255]!;
  return ~crc >>> 0;
}

/**
 * Unpack zlib data to a known number of bytes. What is behind these is left out, as decoders of
 * pictures do; so is what a stream claims to hold beyond them.
 */
export async function unpack(
  parts: Uint8Array<ArrayBuffer>[],
  size: number,
  name: string,
): Promise<Uint8Array<ArrayBuffer>> {
  const out = new Uint8Array(size);
  const reader = new Blob(parts).stream().pipeThrough(new DecompressionStream("deflate")).getReader();
  let filled = 0;
  try {
    while (filled < size) {
      const { done, value } = await reader.read();
      if (done) break;
      out.set(value.subarray(0, size - filled), filled);
      filled += value.length;
    }
  } catch {
    throw damaged(name, "its packed pixels cannot be unpacked");
  } finally {
    reader.cancel().catch(() => undefined); // an error behind the pixels does not matter
  }
  if (filled < size) throw damaged(name, "its packed pixels are cut short");
  return out;
}

/** Give the browser time to draw and to hear a click. */
export async function breathe(signal: AbortSignal): Promise<void> {
  signal.throwIfAborted();
  await new Promise((resolve) => setTimeout(resolve));
  signal.throwIfAborted();
}
