/** WebP: still pictures and animations, which are composed here as libwebp does. */

import { decodeInBrowser, type Pixels } from "./browser";
import { Bytes, text } from "./bytes";
import { checkPixels, damaged, type Size } from "./errors";
import { lumaOfPixels, type Picture } from "./luma";
import { orientationOf, orientationOfXmp, upright } from "./orientation";
import type { Pictures } from "./pictures";

const [HAS_ALPHA, ANIMATED] = [0x10, 0x02];
const [TO_BACKGROUND, REPLACES] = [1, 2];

interface Chunk {
  kind: string;
  body: Uint8Array<ArrayBuffer>;
}

interface Part extends Size {
  left: number;
  top: number;
  milliseconds: number;
  flags: number;
  chunks: Chunk[];
}

/** Read the pictures of a WebP. */
export function webpPictures(data: Uint8Array<ArrayBuffer>, name: string): Pictures {
  if (data.length < 20) throw damaged(name, "the WebP is cut short within its header");
  const end = 8 + new DataView(data.buffer, data.byteOffset).getUint32(4, true);
  if (data.length < end) {
    const missing = end - data.length;
    throw damaged(name, `it is ${missing} bytes shorter than it says; it may be cut short`);
  }
  if (data.subarray(end).some((byte) => byte !== 0)) {
    throw damaged(name, `${data.length - end} bytes follow its end`);
  }
  const chunks = split(data.subarray(12, end), name);
  const find = (kind: string): Chunk | undefined => chunks.find((chunk) => chunk.kind === kind);
  const [head, exif, xmp] = ["VP8X", "EXIF", "XMP "].map(find);
  let orientation = exif ? orientationOf(exif.body) : 1;
  if (orientation === 1 && xmp) orientation = orientationOfXmp(xmp.body);
  const flags = head?.body[0] ?? 0;
  if (head && flags & ANIMATED) {
    const size = { cols: 1 + triple(head.body, 4), rows: 1 + triple(head.body, 7) };
    checkPixels(size, name);
    const parts = chunks.filter(({ kind }) => kind === "ANMF").map(({ body }) => part(body, size, name));
    if (!parts.length) throw damaged(name, "the animation has no pictures");
    const each = compose(parts, size, (flags & HAS_ALPHA) !== 0, orientation, name);
    return { count: parts.length, each, duration: parts[0]!.milliseconds };
  }
  async function* still(): AsyncGenerator<Picture> {
    const pixels = await decode(chunks, name);
    checkPixels(pixels, name);
    yield upright(
      { rows: pixels.rows, cols: pixels.cols, data: lumaOfPixels(pixels.data, true) },
      orientation,
    );
  }
  return { count: 1, each: still() };
}

async function* compose(
  parts: Part[],
  size: Size,
  alpha: boolean,
  orientation: number,
  name: string,
): AsyncGenerator<Picture> {
  const screen = new Uint8Array(4 * size.rows * size.cols);
  for (const [index, one] of parts.entries()) {
    const where = parts.length > 1 ? `${name}, frame ${index}` : name;
    const pixels = await decode(one.chunks, where);
    if (pixels.rows !== one.rows || pixels.cols !== one.cols) {
      throw damaged(where, "its size is not what it states");
    }
    lay(screen, size.cols, one, pixels);
    yield upright({ ...size, data: lumaOfPixels(screen, alpha) }, orientation);
    if (one.flags & TO_BACKGROUND) {
      for (let row = 0; row < one.rows; row++) {
        const start = 4 * ((one.top + row) * size.cols + one.left);
        screen.fill(0, start, start + 4 * one.cols);
      }
    }
  }
}

/** Lay a part over the screen; colours are not multiplied with their alpha. */
function lay(screen: Uint8Array, width: number, part: Part, { data }: Pixels): void {
  for (let row = 0, from = 0; row < part.rows; row++) {
    let to = 4 * ((part.top + row) * width + part.left);
    for (let col = 0; col < part.cols; col++, from += 4, to += 4) {
      const alpha = data[from + 3]!;
      if (part.flags & REPLACES || alpha === 255) {
        for (let c = 0; c < 4; c++) screen[to + c] = data[from + c]!;
      } else if (alpha > 0) {
        const kept = (screen[to + 3]! * (256 - alpha)) >> 8;
        const sum = alpha + kept;
        const scale = Math.floor((1 << 24) / sum);
        for (let c = 0; c < 3; c++) {
          const mixed = data[from + c]! * alpha + screen[to + c]! * kept;
          screen[to + c] = Math.floor((mixed * scale) / (1 << 24));
        }
        screen[to + 3] = sum;
      }
    }
  }
}

function part(body: Uint8Array<ArrayBuffer>, size: Size, name: string): Part {
  if (body.length < 16) throw damaged(name, "a part of the animation is cut short");
  const place = {
    left: 2 * triple(body, 0),
    top: 2 * triple(body, 3),
    cols: 1 + triple(body, 6),
    rows: 1 + triple(body, 9),
  };
  if (place.left + place.cols > size.cols || place.top + place.rows > size.rows) {
    throw damaged(name, "a part of the animation lies outside of the picture");
  }
  const chunks = split(body.subarray(16), name);
  return { ...place, milliseconds: triple(body, 12), flags: body[15]!, chunks };
}

function triple(body: Uint8Array, at: number): number {
  return (body[at] ?? 0) | ((body[at + 1] ?? 0) << 8) | ((body[at + 2] ?? 0) << 16);
}

function split(data: Uint8Array<ArrayBuffer>, name: string): Chunk[] {
  const bytes = new Bytes(data);
  const chunks: Chunk[] = [];
  while (bytes.left >= 8) {
    const kind = text(bytes.take(4)!);
    bytes.at += 4;
    const length = bytes.view.getUint32(bytes.at - 4, true);
    const body = bytes.take(length);
    if (!body) throw damaged(name, `a part '${kind}' is cut short`);
    bytes.at += length & 1;
    chunks.push({ kind, body });
  }
  return chunks;
}

/** Decode the picture in some chunks, without their profiles and notes. */
function decode(chunks: Chunk[], name: string): Promise<Pixels> {
  const image = chunks.find(({ kind }) => kind === "VP8 " || kind === "VP8L");
  if (!image) throw damaged(name, "the WebP holds no picture");
  const alpha = image.kind === "VP8 " ? chunks.find(({ kind }) => kind === "ALPH") : undefined;
  const kept: Chunk[] = [image];
  if (alpha) {
    const body = new Uint8Array(10);
    const view = new DataView(image.body.buffer, image.body.byteOffset, image.body.length);
    if (view.byteLength < 10) throw damaged(name, "the WebP is cut short");
    const [cols, rows] = [view.getUint16(6, true) & 0x3fff, view.getUint16(8, true) & 0x3fff];
    body[0] = HAS_ALPHA;
    for (let byte = 0; byte < 3; byte++) {
      body[4 + byte] = (cols - 1) >> (8 * byte);
      body[7 + byte] = (rows - 1) >> (8 * byte);
    }
    kept.unshift({ kind: "VP8X", body }, alpha);
  }
  const written = kept.flatMap(write);
  const length = written.reduce((sum, bytes) => sum + bytes.length, 4);
  const riff = write({ kind: "RIFF", body: new Uint8Array(0) })[0]!;
  new DataView(riff.buffer).setUint32(4, length, true);
  return decodeInBrowser([riff, new TextEncoder().encode("WEBP"), ...written], "image/webp", name);
}

function write({ kind, body }: Chunk): Uint8Array<ArrayBuffer>[] {
  const head = new Uint8Array(8);
  head.set(new TextEncoder().encode(kind));
  new DataView(head.buffer).setUint32(4, body.length, true);
  return body.length & 1 ? [head, body, new Uint8Array(1)] : [head, body];
}
