/** GIF: damage that browsers pass over. */

import { animated } from "./animation";
import { checkPixels, damaged } from "./errors";
import type { Pictures } from "./pictures";

const HEAD = 13;
const TRAILER = 0x3b;

/** Read the pictures of a GIF. */
export function gifPictures(data: Uint8Array<ArrayBuffer>, name: string): Promise<Pictures> {
  let end = data.length - 1;
  while (data[end] === 0) end--;
  if (end < HEAD || data[end] !== TRAILER) {
    throw damaged(name, "the GIF does not end where it should; it may be cut short");
  }
  const view = new DataView(data.buffer, data.byteOffset);
  checkPixels({ rows: view.getUint16(8, true), cols: view.getUint16(6, true) }, name);
  return animated(data, "image/gif", name);
}
