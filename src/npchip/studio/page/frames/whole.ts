/** Checks that a video is complete: mediabunny reads one that is cut short without an error. */

import { text } from "./bytes";
import { damaged } from "./errors";

const SEGMENT = 0x18538067;
const EBML = 0x1a45dfa3;

/** Throw if the outermost parts of an MP4, MOV, WebM or Matroska file reach behind its end. */
export async function checkWhole(file: File): Promise<void> {
  let at = 0;
  while (file.size - at >= 8) {
    const head = new DataView(await file.slice(at, at + 16).arrayBuffer());
    const matroska = [EBML, SEGMENT].includes(head.getUint32(0));
    const length = matroska ? elementLength(head) : boxLength(head);
    if (length === null) return;
    at += length;
  }
  if (at > file.size) {
    throw damaged(file.name, `the file is cut short: ${at - file.size} bytes are missing`);
  }
}

/** Return the length of a box; null if it reaches to the end, or is none. */
function boxLength(head: DataView): number | null {
  const kind = new Uint8Array(head.buffer, 4, 4);
  if (!/^[\w ]{4}$/.test(text(kind))) return null;
  const length = head.getUint32(0);
  if (length === 1 && head.byteLength === 16) return Number(head.getBigUint64(8));
  return length < 8 ? null : length;
}

/** Return the length of an element; null if it reaches to the end, as of a live stream. */
function elementLength(head: DataView): number | null {
  const width = Math.clz32(head.getUint8(4)) - 23;
  if (width > 8 || 4 + width > head.byteLength) return null;
  let length = head.getUint8(4) & (0xff >> width);
  for (let byte = 1; byte < width; byte++) length = length * 256 + head.getUint8(4 + byte);
  return length === 2 ** (7 * width) - 1 ? null : 4 + width + length;
}
