/**
 * All pictures of a video, in order and exactly once each.
 *
 * mediabunny takes the file apart and lets WebCodecs decode it: one picture comes out for each that
 * is shown, with its own luma. A `<video>` would not do: it drops pictures when it plays, lands on
 * either side of a time when it seeks, and its pixels have passed through colours.
 */

import {
  EncodedPacketSink,
  Input,
  type InputVideoTrack,
  MATROSKA,
  MP4,
  QTFF,
  UnsupportedInputFormatError,
  VideoSampleSink,
  WEBM,
} from "mediabunny";
import type { Clip } from "../protocol";
import { standsAt } from "./bytes";
import { checkPixels, damaged, type Fit, FramesError, notHere, type Size } from "./errors";
import { jpegPicture } from "./jpeg";
import { suffixOf } from "./kinds";
import type { Picture } from "./luma";
import { turn } from "./orientation";
import { pngPictures } from "./png";
import { sourceOf } from "./source";
import { Frames, type Progress } from "./take";
import { coloursOf, lumaOfFrame } from "./videoluma";
import { checkWhole } from "./whole";

/** Milliseconds after which a decoder that gives nothing is given up. */
const PATIENCE = 30_000;
const CONVERT = "Convert it: ffmpeg -i FILE -c:v libvpx-vp9 -lossless 1 FILE.webm";

/** A picture and its time in seconds. */
interface Shown {
  picture: Picture;
  time: number;
}

/** Read the frames of a video. */
export async function openVideo(
  file: File,
  size: Size,
  fit: Fit | null,
  onProgress: Progress,
  signal: AbortSignal,
): Promise<Clip> {
  const { name } = file;
  await checkKind(file);
  await checkWhole(file);
  const input = new Input({ source: sourceOf(file), formats: [MP4, QTFF, WEBM, MATROSKA] });
  const frames = new Frames(name, size, fit, signal);
  let pictures: AsyncGenerator<Shown> | null = null;
  try {
    const track = await videoTrack(input, name);
    const turned = await turning(track, name);
    const length = await track.getDurationFromMetadata();
    const written = String(await track.getInternalCodecId());
    const times: number[] = [];
    const where = (): string => `${name}, frame ${frames.count}`;
    pictures = /^(png |jpeg|mjp[ga])$/.test(written)
      ? stills(track, written === "png ", where)
      : decoded(track, written, name, where);
    for (;;) {
      const next = await inTime(pictures.next(), name, signal);
      if (next.done) break;
      const { picture, time } = next.value;
      if (time < 0) continue; // the file's own list of cuts leaves it out
      frames.add(turned(picture), where());
      times.push(time);
      onProgress(length ? Math.min(1, time / length) : null);
      await frames.breathe();
    }
    await checkEnd(track, name);
    return frames.clip(rate(times));
  } catch (error) {
    throw explained(error, `${name}, frame ${frames.count}`);
  } finally {
    pictures?.return(undefined).catch(() => undefined); // gives back what is decoded ahead
    input.dispose();
  }
}

/** Tell mistakes of mediabunny and of decoders in the words of this page. */
function explained(error: unknown, where: string): unknown {
  if (error instanceof FramesError) return error;
  if (error instanceof DOMException) {
    const other = error.name === "AbortError" || error.name === "NotReadableError";
    return other ? error : damaged(where, error.message);
  }
  return damaged(where, "its parts do not fit together");
}

async function checkKind(file: File): Promise<void> {
  const start = new Uint8Array(await file.slice(0, 16).arrayBuffer());
  if (standsAt(start, 0, "RIFF") || standsAt(start, 0, "\0\0\x01")) {
    const kind = suffixOf(file.name).slice(1).toUpperCase();
    throw notHere(file.name, `browsers read no ${kind} video`, CONVERT);
  }
}

async function videoTrack(input: Input, name: string): Promise<InputVideoTrack> {
  let track: InputVideoTrack | undefined;
  try {
    [track] = await input.getVideoTracks();
  } catch (error) {
    if (!(error instanceof UnsupportedInputFormatError)) throw error;
    throw damaged(name, "it does not begin as a video");
  }
  if (!track) {
    const help = "Choose a file with a video";
    throw new FramesError("NP227", `${name}: holds no video, only other streams`, help);
  }
  checkPixels({ rows: await track.getCodedHeight(), cols: await track.getCodedWidth() }, name);
  return track;
}

/** Return what turns a picture as the file says. */
async function turning(
  track: InputVideoTrack,
  name: string,
): Promise<(picture: Picture) => Picture> {
  const [a, b, , c, d] = await track.getTransformationMatrix();
  if ((a || d) && (b || c)) {
    throw new FramesError(
      "NP228",
      `${name}: expected an orientation in steps of 90 degrees, found another angle`,
      "Let a video editor turn it, and save it without a display matrix",
    );
  }
  // x' = ax + cy, y' = bx + dy
  if (b && c) return (picture) => turn(picture, true, c < 0, b < 0);
  if (a < 0 || d < 0) return (picture) => turn(picture, false, d < 0, a < 0);
  return (picture) => picture;
}

/** Yield the pictures of a video that stores each as an image. */
async function* stills(
  track: InputVideoTrack,
  png: boolean,
  where: () => string,
): AsyncGenerator<Shown> {
  for await (const { data, timestamp: time } of new EncodedPacketSink(track).packets()) {
    const copy = data.slice();
    if (png) for await (const picture of pngPictures(copy, where()).each) yield { picture, time };
    else yield { picture: await jpegPicture(copy, where()), time };
  }
}

/** Yield the pictures of a video that the browser decodes. */
async function* decoded(
  track: InputVideoTrack,
  written: string,
  name: string,
  where: () => string,
): AsyncGenerator<Shown> {
  const hardwareAcceleration = await acceleration(track, written, name);
  await checkOpaque(track, name);
  const [codec, rows, space] = [
    (await track.getCodecParameterString()) ?? "",
    await track.getCodedHeight(),
    await track.getColorSpace(),
  ];
  const colours = coloursOf(codec, rows, space);
  const sink = new VideoSampleSink(track, { hardwareAcceleration });
  for await (const sample of sink.samples()) {
    const frame = sample.toVideoFrame();
    try {
      yield { picture: await lumaOfFrame(frame, colours, where()), time: sample.timestamp };
    } finally {
      frame.close();
      sample.close();
    }
  }
}

/** Return how the browser decodes a video, if it does. */
async function acceleration(
  track: InputVideoTrack,
  written: string,
  name: string,
): Promise<"prefer-software" | "no-preference"> {
  if (typeof VideoDecoder === "undefined") {
    const help =
      "Open the page from https or 127.0.0.1 in a browser of today, or convert it to .npy";
    throw notHere(name, "this browser gives pages no video decoder (WebCodecs)", help);
  }
  const config = await track.getDecoderConfig();
  if (config) {
    // Software decoders give the same pictures everywhere, and do not run out of surfaces.
    for (const way of ["prefer-software", "no-preference"] as const) {
      const asked = { ...config, hardwareAcceleration: way };
      const answer = await VideoDecoder.isConfigSupported(asked).catch(() => null);
      if (answer?.supported) return way;
    }
  }
  throw notHere(name, `this browser has no decoder for its video (${written})`, CONVERT);
}

async function checkOpaque(track: InputVideoTrack, name: string): Promise<void> {
  // Browsers say of what they record that it may be transparent; it is only if this follows.
  const first = await new EncodedPacketSink(track).getFirstPacket();
  if (!first?.sideData.alpha) return;
  const help =
    "Convert it to one without: ffmpeg -i FILE -c:v libvpx-vp9 -pix_fmt yuv420p OTHER.webm";
  throw notHere(name, "a video with transparent parts, which browsers leave out", help);
}

/** Throw if the data of the last picture is missing: mediabunny ends before it, silently. */
async function checkEnd(track: InputVideoTrack, name: string): Promise<void> {
  const packets = new EncodedPacketSink(track);
  const stated = await packets.getPacket(Number.POSITIVE_INFINITY, { metadataOnly: true });
  if (stated && !(await packets.getPacket(Number.POSITIVE_INFINITY))) {
    throw damaged(name, "the file is cut short: pictures at its end are missing");
  }
}

/** Wait for a picture, but not for ever, and not after the reader has stopped the work. */
async function inTime<T>(work: Promise<T>, name: string, signal: AbortSignal): Promise<T> {
  let clean = (): void => undefined;
  const end = new Promise<never>((_, reject) => {
    const stuck = damaged(name, "the browser's decoder gave no picture for 30 s");
    const timer = setTimeout(() => reject(stuck), PATIENCE);
    const stop = (): void => reject(signal.reason);
    signal.addEventListener("abort", stop);
    clean = () => {
      clearTimeout(timer);
      signal.removeEventListener("abort", stop);
    };
  });
  try {
    return await Promise.race([work, end]);
  } finally {
    clean();
  }
}

/** Return frames per second from the times of pictures; null for a single one. */
function rate(times: number[]): number | null {
  const span = times.length > 1 ? times.at(-1)! - times[0]! : 0;
  return span > 0 ? Math.round((1000 * (times.length - 1)) / span) / 1000 : null;
}
