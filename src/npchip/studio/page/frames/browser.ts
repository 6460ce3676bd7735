/**
 * Pictures decoded by the browser: JPEG and WebP, as its decoders (libjpeg-turbo, libwebp) are those
 * of Pillow, and BMP. The file goes to it without colour profile and EXIF, so that it changes nothing.
 */

import { damaged, FramesError, type Size } from "./errors";

/** A picture of four bytes a pixel: red, green, blue and opacity, not multiplied. */
export interface Pixels extends Size {
  data: Uint8Array;
}

/** Decode a picture to the values that are stored. */
export async function decodeInBrowser(
  parts: Uint8Array<ArrayBuffer>[],
  type: string,
  name: string,
): Promise<Pixels> {
  let bitmap: ImageBitmap;
  try {
    bitmap = await createImageBitmap(new Blob([joined(parts)], { type }), {
      colorSpaceConversion: "none",
      premultiplyAlpha: "none",
    });
  } catch {
    throw damaged(name, "the browser cannot decode it");
  }
  try {
    const { height: rows, width: cols } = bitmap;
    return { rows, cols, data: (await copied(bitmap)) ?? readBack(bitmap, name) };
  } finally {
    bitmap.close();
  }
}

/** Join parts: Firefox tells the kind of a picture by the first part of a blob only. */
function joined(parts: Uint8Array<ArrayBuffer>[]): Uint8Array<ArrayBuffer> {
  const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}

/**
 * Copy pixels through a video frame: unlike a canvas it neither multiplies with alpha nor adds
 * noise against fingerprinting. Null where the browser cannot.
 */
async function copied(bitmap: ImageBitmap): Promise<Uint8Array | null> {
  if (typeof VideoFrame === "undefined") return null;
  const frame = new VideoFrame(bitmap, { timestamp: 0 });
  try {
    const { data } = await pixelsOf(frame, "");
    return data.length === 4 * bitmap.width * bitmap.height ? data : null;
  } catch {
    return null; // formats cannot be converted here
  } finally {
    frame.close();
  }
}

/** Copy the pixels of a frame. */
export async function pixelsOf(frame: VideoFrame, name: string): Promise<Pixels> {
  const options: VideoFrameCopyToOptions = { format: "RGBA" };
  try {
    const data = new Uint8Array(frame.allocationSize(options));
    await frame.copyTo(data, options);
    const opaque = frame.format?.endsWith("X") ?? false;
    if (opaque) for (let at = 3; at < data.length; at += 4) data[at] = 255;
    const area = frame.visibleRect;
    return { rows: area?.height ?? frame.codedHeight, cols: area?.width ?? frame.codedWidth, data };
  } catch {
    const help = "Open it in another browser, or convert it to .npy";
    throw new FramesError("NP211", `${name}: the browser does not hand out its pixels`, help);
  }
}

function readBack(bitmap: ImageBitmap, name: string): Uint8Array {
  checkCanvas(name);
  const { width, height } = bitmap;
  const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  if (!context) throw new FramesError("NP211", `${name}: the browser gives no canvas to read it`);
  context.drawImage(bitmap, 0, 0);
  return new Uint8Array(context.getImageData(0, 0, width, height).data.buffer);
}

let trusted: boolean | null = null;

/** Throw if the browser changes what is read from a canvas, as it may to hide who uses it. */
export function checkCanvas(name: string): void {
  trusted ??= canvasIsExact();
  if (trusted) return;
  throw new FramesError(
    "NP211",
    `${name}: this browser alters pictures that a page reads, to guard against fingerprinting`,
    "Allow this page to extract canvas data, or open PNG or .npy files, which need no canvas",
  );
}

/** Draw known pixels and read them. */
function canvasIsExact(): boolean {
  const side = 16;
  const context = new OffscreenCanvas(side, side).getContext("2d", { willReadFrequently: true });
  if (!context) return false;
  const image = context.createImageData(side, side);
  for (let at = 0; at < image.data.length; at++) image.data[at] = at % 4 === 3 ? 255 : (at * 37) & 255;
  context.putImageData(image, 0, 0);
  const read = context.getImageData(0, 0, side, side).data;
  return read.every((value, at) => value === image.data[at]);
}
