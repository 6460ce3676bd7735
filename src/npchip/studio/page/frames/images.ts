/** Frames of image files: their format is told by their first bytes, as npchip's Python does. */

import { bmpPicture } from "./bmp";
import { standsAt } from "./bytes";
import { damaged, type Fit, FramesError, notHere, type Size } from "./errors";
import { gifPictures } from "./gif";
import { jpegPicture } from "./jpeg";
import { resemblance } from "./kinds";
import { type Pictures, single } from "./pictures";
import { pngPictures } from "./png";
import { pnmPictures } from "./pnm";
import { Frames, type Progress } from "./take";
import { webpPictures } from "./webp";
import type { Clip } from "../protocol";

/** Most bytes of an image file that are read. */
const LONGEST = 1 << 29;

/** Read the pictures of an image file. */
export async function picturesOf(file: File, name: string): Promise<Pictures> {
  if (file.size > LONGEST) {
    const help = "Cut it into smaller files, or run it outside of the page: npchip run --frames";
    throw new FramesError("NP222", `${name}: a file of ${file.size} bytes is too large`, help);
  }
  const data = new Uint8Array(await file.arrayBuffer());
  if (standsAt(data, 0, "\x89PNG\r\n\x1a\n")) return pngPictures(data, name);
  if (standsAt(data, 0, "\xff\xd8\xff")) return single(() => jpegPicture(data, name));
  if (standsAt(data, 0, "GIF87a") || standsAt(data, 0, "GIF89a")) return await gifPictures(data, name);
  if (standsAt(data, 0, "BM")) return single(() => bmpPicture(data, name));
  if (standsAt(data, 0, "RIFF") && standsAt(data, 8, "WEBP")) return webpPictures(data, name);
  if (standsAt(data, 0, "P") && /[0-6fFy]/.test(String.fromCharCode(data[1] ?? 0))) {
    return pnmPictures(data, name);
  }
  if (["II*\0", "MM\0*", "II+\0", "MM\0+"].some((start) => standsAt(data, 0, start))) {
    const help = "Save it as PNG or GIF, or as an array: np.save('clip.npy', tifffile.imread(path))";
    throw notHere(name, "a TIFF, which this page does not read (npchip run does)", help);
  }
  const help = resemblance(data.subarray(0, 16), file.name);
  throw damaged(name, "not one of PNG, JPEG, BMP, GIF, WEBP, PPM", help);
}

/** Read all pictures of one file. */
export async function openImage(
  file: File,
  size: Size,
  fit: Fit | null,
  onProgress: Progress,
  signal: AbortSignal,
): Promise<Clip> {
  const { count, each, duration } = await picturesOf(file, file.name);
  const frames = new Frames(file.name, size, fit, signal, count);
  for await (const picture of each) {
    frames.add(picture, `${file.name}, frame ${frames.count}`);
    onProgress(frames.count / count);
    await frames.breathe();
  }
  return frames.clip(duration ? 1000 / duration : null);
}

/** Read a frame of each file; `files` are in order. */
export async function openImages(
  files: File[],
  name: string,
  size: Size,
  fit: Fit | null,
  onProgress: Progress,
  signal: AbortSignal,
): Promise<Clip> {
  const frames = new Frames(name, size, fit, signal, files.length);
  for (const file of files) {
    const { count, each } = await picturesOf(file, file.name);
    if (count > 1) {
      throw new FramesError(
        "NP223",
        `${file.name}: expected one picture in each image of a list, found ${count}`,
        "Open an animation by itself to take all of its pictures",
      );
    }
    for await (const picture of each) frames.add(picture, file.name);
    onProgress(frames.count / files.length);
    await frames.breathe();
  }
  return frames.clip(null);
}
