/** BMP without packing, read here, as its alpha is not what a browser takes it for. */

import { checkPixels, damaged, notHere } from "./errors";
import { lumaOfPixels, type Picture } from "./luma";
import { paletteLuma } from "./raster";

/** Bits of red, green, blue and alpha in a pixel, as masks. */
type Masks = [number, number, number, number];

/** Read a BMP; black for what is transparent, unless no pixel is opaque. */
export function bmpPicture(data: Uint8Array<ArrayBuffer>, name: string): Picture {
  const view = new DataView(data.buffer, data.byteOffset, data.length);
  if (data.length < 26) throw damaged(name, "the BMP is cut short within its header");
  const size = view.getUint32(14, true);
  const old = size === 12;
  if (!old && ![40, 52, 56, 64, 108, 124].includes(size)) {
    throw damaged(name, `no BMP has a header of ${size} bytes`);
  }
  if (data.length < 14 + size) throw damaged(name, "the BMP is cut short within its header");
  const word = (at: number): number => view.getUint32(at, true);
  const tall = old ? view.getUint16(20, true) : view.getInt32(22, true);
  const cols = old ? view.getUint16(18, true) : word(18);
  const down = !old && data[25] === 0xff; // rows from above
  const rows = down ? -tall : tall >>> 0;
  const bits = view.getUint16(old ? 24 : 28, true);
  const packing = old ? 0 : word(30);
  checkPixels({ rows, cols }, name);
  if (packing === 1 || packing === 2) {
    throw notHere(name, "a BMP with packed pixels (RLE)", "Save it as PNG, or as a BMP without");
  }
  if (packing !== 0 && packing !== 3) throw damaged(name, `no BMP packs its pixels by ${packing}`);
  const colours = bits <= 8 ? ((old ? 0 : word(46)) || 1 << bits) : 0;
  const entry = old ? 3 : 4;
  let start = word(10);
  if (start === 14 + size && bits <= 8) start += entry * colours;
  const width = ((cols * bits + 31) >> 5) << 2;
  const reason = lengthDamage(data, word(10), size, word(2), start + width * rows);
  if (reason) throw damaged(name, reason);
  const line = (row: number): number => start + (down ? row : rows - 1 - row) * width;
  const out: Picture = { rows, cols, data: new Uint8Array(rows * cols) };
  if (bits === 1 || bits === 4 || bits === 8) {
    const shades = paletteLuma(palette(data, 14 + size, entry, colours));
    for (let row = 0; row < rows; row++) {
      for (let col = 0; col < cols; col++) {
        const bit = col * bits;
        const byte = data[line(row) + (bit >> 3)]!;
        out.data[row * cols + col] = shades[(byte >> (8 - bits - (bit & 7))) & (2 ** bits - 1)]!;
      }
    }
    return out;
  }
  const masks = masksOf(bits, packing, size, word);
  if (!masks) throw notHere(name, `a BMP of ${bits} bits a pixel in a rare order`, "Save it as PNG");
  const pixels = new Uint8Array(rows * cols * 4);
  for (let row = 0; row < rows; row++) {
    for (let col = 0; col < cols; col++) {
      const at = line(row) + ((col * bits) >> 3);
      let value = data[at]! | (data[at + 1]! << 8);
      if (bits > 16) value |= data[at + 2]! << 16;
      if (bits > 24) value |= data[at + 3]! << 24;
      for (let c = 0; c < 4; c++) pixels[(row * cols + col) * 4 + c] = channel(value, masks[c]!);
    }
  }
  const clear = masks[3] !== 0 && pixels.some((value, at) => at % 4 === 3 && value !== 0);
  out.data = lumaOfPixels(pixels, clear);
  return out;
}

/** Take a channel out of a pixel, scaled to 0-255 and cut off as Pillow does. */
function channel(pixel: number, mask: number): number {
  if (mask === 0) return 0;
  const shift = 31 - Math.clz32(mask & -mask);
  const most = mask >>> shift;
  return Math.floor((((pixel & mask) >>> shift) * 255) / most);
}

function masksOf(
  bits: number,
  packing: number,
  size: number,
  word: (at: number) => number,
): Masks | null {
  const plain: Masks = [0xff0000, 0xff00, 0xff, 0];
  if (packing === 0) {
    if (bits === 16) return [0x7c00, 0x3e0, 0x1f, 0];
    return bits === 24 || bits === 32 ? plain : null;
  }
  const found: Masks = [word(54), word(58), word(62), size >= 56 ? word(66) : 0];
  const known: Record<number, Masks[]> = {
    16: [
      [0xf800, 0x7e0, 0x1f, 0],
      [0x7c00, 0x3e0, 0x1f, 0],
    ],
    24: [plain],
    32: [
      plain,
      [0xff000000, 0xff0000, 0xff00, 0],
      [0xff000000, 0xff00, 0xff, 0],
      [0xff000000, 0xff0000, 0xff00, 0xff],
      [0xff, 0xff00, 0xff0000, 0xff000000],
      [0xff0000, 0xff00, 0xff, 0xff000000],
      [0xff000000, 0xff00, 0xff, 0xff0000],
    ],
  };
  if (bits === 32 && found.every((mask) => mask === 0)) return [...plain.slice(0, 3), 0xff000000] as Masks;
  const counted = bits === 32 ? 4 : 3;
  return known[bits]?.find((masks) => masks.slice(0, counted).every((m, c) => m === found[c])) ?? null;
}

function palette(data: Uint8Array, at: number, entry: number, colours: number): Uint8Array {
  const out = new Uint8Array(768);
  for (let index = 0; index < Math.min(colours, 256); index++) {
    for (let c = 0; c < 3; c++) out[3 * index + c] = data[at + entry * index + 2 - c] ?? 0;
  }
  return out;
}

/** Return what is wrong with the length of a BMP; null if nothing is. */
function lengthDamage(
  data: Uint8Array,
  pixels: number,
  header: number,
  stated: number,
  needed: number,
): string | null {
  if (pixels < 14 + header) return "its pixels begin within its header";
  const end = Math.max(stated > pixels ? stated : 0, needed); // some programs state 0
  if (data.length < end) {
    return `it is ${end - data.length} bytes shorter than it says; it may be cut short`;
  }
  const behind = data.subarray(end).some((byte) => byte !== 0);
  return behind ? `${data.length - end} bytes follow its end` : null;
}
