/** The luma of a decoded picture, stretched to 0-255 as npchip's Python does. */

import { checkPixels, FramesError } from "./errors";
import { lumaOfPixels, type Picture } from "./luma";

/** Return a picture's own luma; of colours, if the decoder gives these only. */
export async function lumaOfFrame(frame: VideoFrame, name: string): Promise<Picture> {
  const area = frame.visibleRect;
  const [rows, cols] = [area?.height ?? frame.codedHeight, area?.width ?? frame.codedWidth];
  checkPixels({ rows, cols }, name);
  const { format } = frame;
  if (!format || !/^(I4|NV)/.test(format)) {
    const options: VideoFrameCopyToOptions = { format: "RGBA" };
    try {
      const pixels = new Uint8Array(frame.allocationSize(options));
      await frame.copyTo(pixels, options);
      return { rows, cols, data: lumaOfPixels(pixels, false) };
    } catch {
      const help = "Open it in another browser, or convert it to .npy";
      throw new FramesError("NP211", `${name}: the browser does not hand out its pixels`, help);
    }
  }
  const buffer = new Uint8Array(frame.allocationSize());
  const [plane] = await frame.copyTo(buffer);
  const { offset, stride } = plane!;
  const depth = Number(/P(10|12)$/.exec(format)?.[1] ?? 8);
  const shades = stretch(depth, frame.colorSpace.fullRange === true);
  const data = new Uint8Array(rows * cols);
  const wide = depth > 8 ? 2 : 1;
  for (let row = 0, at = 0; row < rows; row++) {
    let from = offset + row * stride;
    for (let col = 0; col < cols; col++, from += wide) {
      const value = wide === 1 ? buffer[from]! : buffer[from]! | (buffer[from + 1]! << 8);
      data[at++] = shades[value]!;
    }
  }
  return { rows, cols, data };
}

const tables = new Map<string, Uint8Array>();

/** Return the grey of each value: videos use 16-235 of 8 bits unless they say that they use all. */
function stretch(depth: number, full: boolean): Uint8Array {
  const key = `${depth} ${full}`;
  let table = tables.get(key);
  if (!table) {
    const unit = 2 ** (depth - 8);
    const [least, span] = full ? [0, 2 ** depth - 1] : [16 * unit, 219 * unit];
    table = Uint8Array.from({ length: 2 ** depth }, (_, value) =>
      Math.min(255, Math.max(0, Math.round(((value - least) * 255) / span))),
    );
    tables.set(key, table);
  }
  return table;
}
