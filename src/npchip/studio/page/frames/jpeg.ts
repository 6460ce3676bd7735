/** JPEG: damage that browsers pass over, and what they would apply to the pixels. */

import { decodeInBrowser } from "./browser";
import { standsAt } from "./bytes";
import { checkPixels, damaged, notHere, type Size, tooDeep } from "./errors";
import { lumaOfPixels, type Picture } from "./luma";
import { orientationOf, orientationOfXmp, upright } from "./orientation";

const [START, END, SCAN, COMMENT] = [0xd8, 0xd9, 0xda, 0xfe];
const [JFIF, EXIF_OR_XMP, ADOBE] = [0xe0, 0xe1, 0xee];
/** Tables that are no pictures although their numbers lie between those of pictures. */
const NO_FRAMES = [0xc4, 0xc8, 0xcc];
const XMP = "http://ns.adobe.com/xap/1.0/\0";

interface Jpeg extends Size {
  channels: number;
  /** The file without notes, profiles and what follows its end. */
  kept: Uint8Array<ArrayBuffer>[];
  orientation: number;
}

/** Decode a JPEG. */
export async function jpegPicture(data: Uint8Array<ArrayBuffer>, name: string): Promise<Picture> {
  const jpeg = parse(data, name);
  checkPixels(jpeg, name);
  if (jpeg.channels === 4) {
    const help = "Save it as an RGB JPEG or as PNG";
    throw notHere(name, "a JPEG in print colours (CMYK), which browsers decode differently", help);
  }
  const pixels = await decodeInBrowser(jpeg.kept, "image/jpeg", name);
  const { rows, cols } = pixels;
  if (rows !== jpeg.rows || cols !== jpeg.cols) throw damaged(name, "its size is not what it states");
  return upright({ rows, cols, data: lumaOfPixels(pixels.data, false) }, jpeg.orientation);
}

/** Follow the markers of a JPEG to its end. */
function parse(data: Uint8Array<ArrayBuffer>, name: string): Jpeg {
  if (data[0] !== 0xff || data[1] !== START) throw damaged(name, "a JPEG does not begin so");
  const jpeg: Jpeg = { rows: 0, cols: 0, channels: 0, kept: [], orientation: 0 };
  let xmp = 1;
  let [at, begin, restarts, scans] = [2, 0, 0, 0];
  for (;;) {
    const marker = findMarker(data, at);
    if (marker === null) throw damaged(name, "the JPEG has no end; it may be cut short");
    const kind = data[marker.end - 1]!;
    at = marker.end;
    if (kind === END) break;
    if (kind >= 0xd0 && kind <= 0xd7) {
      if (!scans || kind - 0xd0 !== restarts % 8) {
        const reason = "a part of the JPEG is missing: its restart markers are not in order";
        throw damaged(name, reason);
      }
      restarts++;
      continue;
    }
    if (kind === 0x01 || kind === START) continue;
    const length = ((data[at] ?? 0) << 8) | (data[at + 1] ?? 0);
    if (length < 2 || at + length > data.length) {
      throw damaged(name, "a segment of the JPEG reaches behind its end");
    }
    const body = data.subarray(at + 2, at + length);
    if (kind === SCAN) [restarts, scans] = [0, scans + 1];
    if (kind >= 0xc0 && kind <= 0xcf && !NO_FRAMES.includes(kind)) readFrame(body, jpeg, name);
    at += length;
    const note = (kind >= 0xe0 && kind <= 0xef) || kind === COMMENT;
    if (!note || kind === JFIF || kind === ADOBE) continue;
    if (kind === EXIF_OR_XMP && standsAt(body, 0, "Exif\0\0")) {
      jpeg.orientation ||= orientationOf(body);
    } else if (kind === EXIF_OR_XMP && standsAt(body, 0, XMP)) xmp = orientationOfXmp(body);
    jpeg.kept.push(data.subarray(begin, marker.start));
    begin = at;
  }
  if (!scans || !jpeg.channels) throw damaged(name, "the JPEG holds no pixels");
  jpeg.kept.push(data.subarray(begin, at));
  if (jpeg.orientation <= 1) jpeg.orientation = xmp;
  return jpeg;
}

function readFrame(body: Uint8Array, jpeg: Jpeg, name: string): void {
  if (body.length < 6) throw damaged(name, "the header of the JPEG is cut short");
  if (body[0] !== 8) throw tooDeep(name, `${body[0]}`);
  jpeg.rows = (body[1]! << 8) | body[2]!;
  jpeg.cols = (body[3]! << 8) | body[4]!;
  jpeg.channels = body[5]!;
}

/** Find the next marker; bytes of 0xff may stand before it, and 0xff 0 is none. */
function findMarker(data: Uint8Array, from: number): { start: number; end: number } | null {
  for (let start = data.indexOf(0xff, from); start >= 0; start = data.indexOf(0xff, start)) {
    let at = start;
    while (data[at] === 0xff) at++;
    if (at >= data.length) return null;
    if (data[at] !== 0) return { start, end: at + 1 };
    start = at;
  }
  return null;
}
