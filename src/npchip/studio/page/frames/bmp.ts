/** BMP: damage that browsers pass over, and pixels that they take for others than npchip does. */

import { decodeInBrowser } from "./browser";
import { checkPixels, damaged, notHere } from "./errors";
import { lumaOfPixels, type Picture } from "./luma";

/** Decode a BMP; black for what is transparent. */
export async function bmpPicture(data: Uint8Array<ArrayBuffer>, name: string): Promise<Picture> {
  const view = new DataView(data.buffer, data.byteOffset, data.length);
  if (data.length < 30) throw damaged(name, "the BMP is cut short within its header");
  const old = view.getUint32(14, true) === 12;
  const cols = old ? view.getUint16(18, true) : view.getInt32(18, true);
  const rows = old ? view.getUint16(20, true) : Math.abs(view.getInt32(22, true));
  const bits = view.getUint16(old ? 24 : 28, true);
  checkPixels({ rows, cols }, name);
  checkLength(data, view.getUint32(2, true), name);
  if (bits === 16) {
    const what = "a BMP of 16 bits a pixel, which browsers read in another way than npchip";
    throw notHere(name, what, "Save it as PNG");
  }
  const pixels = await decodeInBrowser([data], "image/bmp", name);
  if (bits === 32 && !pixels.data.some((value, at) => at % 4 === 3 && value !== 0)) {
    const help = "Save it as PNG without transparency";
    throw notHere(name, "a BMP that is transparent all over", help);
  }
  return { rows: pixels.rows, cols: pixels.cols, data: lumaOfPixels(pixels.data, true) };
}

function checkLength(data: Uint8Array, stated: number, name: string): void {
  if (data.length < stated) {
    const missing = stated - data.length;
    throw damaged(name, `it is ${missing} bytes shorter than it says; it may be cut short`);
  }
  // Some programs state 0.
  if (stated > 0 && data.subarray(stated).some((byte) => byte !== 0)) {
    throw damaged(name, `${data.length - stated} bytes follow its end`);
  }
}
