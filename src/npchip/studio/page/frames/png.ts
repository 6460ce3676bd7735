/** PNG and APNG, read here: a browser would apply gamma and colour profiles, and blur alpha. */

import { Bytes, crc32, text } from "./bytes";
import { checkPixels, damaged, tooDeep } from "./errors";
import type { Picture } from "./luma";
import { orientationOf, orientationOfXmp, upright } from "./orientation";
import type { Pictures } from "./pictures";
import { type Layout, layoutOf, lumaOf, opacities, type Raster, samples } from "./raster";

const [NO_DISPOSAL, TO_PREVIOUS] = [0, 2];
const OVER = 1;

/** A part of an animation: its place, how it is put there, and its packed pixels. */
interface Part {
  left: number;
  top: number;
  rows: number;
  cols: number;
  disposal: number;
  blend: number;
  milliseconds: number;
  packed: Uint8Array<ArrayBuffer>[];
}

interface File {
  layout: Layout;
  /** The picture that is shown where animations are not; null if it is the first of these. */
  still: Part | null;
  parts: Part[];
  /** Number of pictures that the animation states; null for a still picture. */
  stated: number | null;
  orientation: number;
  damage: { place: number; reason: string } | null;
}

/** Read the pictures of a PNG; a default image that is no part of an animation is none. */
export function pngPictures(data: Uint8Array<ArrayBuffer>, name: string): Pictures {
  const file = parse(data, name);
  const count = file.stated ?? 1;
  const duration = file.stated === null ? undefined : file.parts[0]?.milliseconds;
  return { count, each: compose(file, count, name), duration };
}

async function* compose(file: File, count: number, name: string): AsyncGenerator<Picture> {
  const { layout, damage } = file;
  const channels = layout.channels;
  let screen: Raster = new Uint8Array(layout.rows * layout.cols * channels);
  let first = true;
  if (file.stated !== null && file.still) {
    screen.set(await samples(layout, file.still, file.still.packed, name));
    first = false; // an animation is drawn over it, as npchip does
  }
  for (let index = 0; index < count; index++) {
    const where = count > 1 ? `${name}, frame ${index}` : name;
    if (damage && index >= damage.place) throw damaged(where, damage.reason);
    const part = file.stated === null ? file.still : file.parts[index];
    if (!part) throw damaged(where, "it holds fewer pictures than it states");
    const before = screen.slice();
    put(screen, await samples(layout, part, part.packed, where), part, layout, !first);
    yield upright(
      { rows: layout.rows, cols: layout.cols, data: lumaOf(layout, screen) },
      file.orientation,
    );
    // Pillow, and npchip with it, keeps what was laid over and should go back; so does this page.
    const back = part.disposal === TO_PREVIOUS && !first;
    if (back && part.blend !== OVER) screen = before;
    else if (!back && part.disposal !== NO_DISPOSAL) clear(screen, part, layout);
    first = false;
  }
}

function put(screen: Raster, pixels: Raster, part: Part, layout: Layout, mix: boolean): void {
  const { channels } = layout;
  const masks = mix && part.blend === OVER ? opacities(layout, pixels) : null;
  const width = part.cols * channels;
  for (let row = 0; row < part.rows; row++) {
    const to = ((part.top + row) * layout.cols + part.left) * channels;
    const from = row * width;
    if (!masks) {
      screen.set(pixels.subarray(from, from + width), to);
      continue;
    }
    for (let at = 0; at < width; at++) {
      const mask = masks[row * part.cols + Math.floor(at / channels)]!;
      const sum = screen[to + at]! * (255 - mask) + pixels[from + at]! * mask + 128;
      screen[to + at] = (sum + (sum >> 8)) >> 8;
    }
  }
}

function clear(screen: Raster, part: Part, layout: Layout): void {
  for (let row = 0; row < part.rows; row++) {
    const start = ((part.top + row) * layout.cols + part.left) * layout.channels;
    screen.fill(0, start, start + part.cols * layout.channels);
  }
}

/** Follow the chunks to the end, or to the damage. */
function parse(data: Uint8Array<ArrayBuffer>, name: string): File {
  const bytes = new Bytes(data, 8);
  const file: Omit<File, "layout"> = {
    still: null,
    parts: [],
    stated: null,
    orientation: 1,
    damage: null,
  };
  let layout: Layout | null = null;
  let part: Part | null = null;
  let begun = 0;
  let sequence = 0;
  let times = 0; // animations that it states
  const end = (reason: string): void => {
    file.damage = { place: Math.max(begun - 1, 0), reason };
  };
  while (!file.damage) {
    const head = bytes.take(8);
    if (!head) {
      end("the PNG has no end; it may be cut short");
      break;
    }
    const kind = text(head.subarray(4));
    const body = bytes.take(new DataView(head.buffer, head.byteOffset).getUint32(0));
    if (kind === "fcTL") begun++;
    const sum = body && bytes.take(4);
    if (!body || !sum) {
      end(`a part '${kind}' is cut short`);
      break;
    }
    const start = bytes.at - body.length - 8;
    if (crc32(data.subarray(start, bytes.at - 4)) !== bytes.view.getUint32(bytes.at - 4)) {
      end(`the checksum of a part '${kind}' is wrong`);
      break;
    }
    const view = new DataView(body.buffer, body.byteOffset, body.length);
    if (kind === "IEND") break;
    if (!layout) {
      if (kind !== "IHDR" || body.length < 13) throw damaged(name, "it does not begin as a PNG");
      layout = layoutOf(view);
      if (!layout) throw damaged(name, "no PNG has such a header");
      checkPixels(layout, name);
      if (layout.depth === 16) throw tooDeep(name, "more");
    } else if (kind === "PLTE") layout.palette = body;
    else if (kind === "tRNS") layout.holes = body;
    else if (kind === "eXIf") file.orientation = orientationOf(body);
    else if (kind === "iTXt" && file.orientation === 1) file.orientation = orientationOfXmp(body);
    else if (kind === "acTL" && !file.still && !part?.packed.length) {
      times++;
      const stated = body.length < 8 ? 0 : view.getUint32(0);
      file.stated = times > 1 || stated === 0 || stated > 0x80000000 ? null : stated;
    } else if (kind === "fcTL" || kind === "fdAT") {
      if (body.length < (kind === "fcTL" ? 26 : 4) || view.getUint32(0) !== sequence++) {
        if (file.stated !== null) end("parts of the animation are missing");
      } else if (kind === "fcTL") {
        part = partOf(view, layout);
        if (part) file.parts.push(part);
        else end("a part of the animation lies outside of the picture");
      } else part?.packed.push(body.subarray(4));
    } else if (kind === "IDAT") {
      file.still ??= { ...whole(layout), packed: [] };
      if (part && file.parts.length === 1 && file.stated !== null) part.packed.push(body);
      file.still.packed.push(body);
    }
  }
  if (!layout) throw damaged(name, file.damage?.reason ?? "it has no header");
  if (layout.kind === "palette" && !layout.palette) throw damaged(name, "it has no palette");
  const inside = file.stated !== null && (file.parts[0]?.packed[0] ?? null) !== null;
  if (inside && file.parts[0]!.packed[0] === file.still?.packed[0]) file.still = null;
  if (!file.still && file.stated === null && !file.damage) throw damaged(name, "it has no pixels");
  return { ...file, layout };
}

function whole(layout: Layout): Omit<Part, "packed"> {
  const { rows, cols } = layout;
  return { left: 0, top: 0, rows, cols, disposal: 0, blend: 0, milliseconds: 0 };
}

function partOf(view: DataView, layout: Layout): Part | null {
  const [cols, rows, left, top] = [4, 8, 12, 16].map((at) => view.getUint32(at)) as [
    number,
    number,
    number,
    number,
  ];
  if (!rows || !cols || left + cols > layout.cols || top + rows > layout.rows) return null;
  const milliseconds = (1000 * view.getUint16(20)) / (view.getUint16(22) || 100);
  const [disposal, blend] = [view.getUint8(24), view.getUint8(25)];
  return { left, top, rows, cols, disposal, blend, milliseconds, packed: [] };
}
