/** Animations, decoded and composed by the browser; what is transparent becomes black. */

import { pixelsOf } from "./browser";
import { damaged, notHere } from "./errors";
import { lumaOfPixels, type Picture } from "./luma";
import type { Pictures } from "./pictures";

/** Read the pictures of a file that is all there: decoders end at what is missing, silently. */
export async function animated(
  data: Uint8Array<ArrayBuffer>,
  type: string,
  name: string,
): Promise<Pictures> {
  if (typeof ImageDecoder === "undefined") {
    const help = "Open it in another browser, or save it as images or as .npy";
    throw notHere(name, "this browser gives pages no decoder of animations (ImageDecoder)", help);
  }
  const decoder = new ImageDecoder({ data, type, colorSpaceConversion: "none" });
  try {
    await decoder.completed;
    await decoder.tracks.ready;
    const count = decoder.tracks.selectedTrack?.frameCount ?? 0;
    // Firefox hands out the same frame when it is asked for it again, closed or not.
    const { image: first } = await decoder.decode();
    const duration = count > 1 ? (first.duration ?? 0) / 1000 : 0;
    return { count, each: decoded(decoder, first, count, name), duration: duration || undefined };
  } catch {
    throw damaged(name, "the browser cannot decode it");
  }
}

async function* decoded(
  decoder: ImageDecoder,
  first: VideoFrame,
  count: number,
  name: string,
): AsyncGenerator<Picture> {
  try {
    for (let frameIndex = 0; frameIndex < count; frameIndex++) {
      const where = `${name}, frame ${frameIndex}`;
      const image = frameIndex === 0 ? first : await decode(decoder, frameIndex, where);
      try {
        const { rows, cols, data } = await pixelsOf(image, where);
        yield { rows, cols, data: lumaOfPixels(data, true) };
      } finally {
        image.close();
      }
    }
  } finally {
    decoder.close();
  }
}

async function decode(
  decoder: ImageDecoder,
  frameIndex: number,
  name: string,
): Promise<VideoFrame> {
  try {
    return (await decoder.decode({ frameIndex })).image;
  } catch {
    throw damaged(name, "the browser cannot decode it");
  }
}
