/**
 * All pictures of a video, in order and exactly once each.
 *
 * The file is taken apart here and WebCodecs decodes its packets: one picture comes out for each
 * that is shown, with its own luma. A `<video>` would not do: it drops pictures when it plays, lands
 * on either side of a time when it seeks, and its pixels have passed through colours.
 */

import type { Clip } from "../protocol";
import { breathe, standsAt } from "./bytes";
import { declaredColours, vp9Colours } from "./declared";
import { checkPixels, damaged, type Fit, FramesError, notHere, type Size } from "./errors";
import { jpegPicture } from "./jpeg";
import { suffixOf } from "./kinds";
import type { Picture } from "./luma";
import { openMp4 } from "./mp4";
import { turn } from "./orientation";
import { pngPictures } from "./png";
import { Region } from "./region";
import { Frames, type Progress } from "./take";
import type { Sample, Track } from "./track";
import { type Colours, coloursOf, lumaOfFrame } from "./videoluma";
import { openWebm } from "./webm";

/** Pictures that may wait in the decoder or behind it. */
const WAITING = 8;
/** Milliseconds after which a decoder that gives nothing is given up. */
const PATIENCE = 30_000;
const CONVERT = "Convert it: ffmpeg -i FILE -c:v libvpx-vp9 -lossless 1 FILE.webm";

/** Read the frames of a video. */
export async function openVideo(
  file: File,
  size: Size,
  fit: Fit | null,
  onProgress: Progress,
  signal: AbortSignal,
): Promise<Clip> {
  const region = new Region(file);
  const track = await openTrack(region);
  const { name } = file;
  checkPixels(track, name);
  const frames = new Frames(name, size, fit, signal, track.count ?? 1);
  const times: number[] = [];
  const take = (picture: Picture, time: number): void => {
    if (time < track.from || time >= track.to) return;
    const { turn: way } = track;
    const turned = way ? turn(picture, way.exchange, way.flipped, way.mirrored) : picture;
    frames.add(turned, `${name}, frame ${frames.count}`);
    times.push(time);
    onProgress(track.count ? Math.min(1, frames.count / track.count) : region.share);
  };
  if (track.written === "png " || /^(jpeg|mjp[ga])$/.test(track.written)) {
    for await (const { data, time } of track.samples()) {
      const where = `${name}, frame ${frames.count}`;
      take(await still(data, track.written === "png ", where), time);
      await frames.breathe();
    }
  } else await decode(track, name, take, frames, signal);
  return frames.clip(rate(times));
}

async function openTrack(region: Region): Promise<Track> {
  const { name } = region;
  const start = await region.read(0, Math.min(16, region.size));
  if (standsAt(start, 0, "\x1aE\xdf\xa3")) return openWebm(region);
  if (/^(ftyp|moov|mdat|free|skip|wide|pnot)/.test(String.fromCharCode(...start.subarray(4, 8)))) {
    return openMp4(region);
  }
  const kind = suffixOf(name);
  const other = standsAt(start, 0, "RIFF") || standsAt(start, 0, "\0\0\x01");
  if (other) throw notHere(name, `browsers read no ${kind.slice(1).toUpperCase()} video`, CONVERT);
  throw damaged(name, "it does not begin as a video");
}

async function still(data: Uint8Array<ArrayBuffer>, png: boolean, name: string): Promise<Picture> {
  if (!png) return jpegPicture(data, name);
  for await (const picture of pngPictures(data, name).each) return picture;
  throw damaged(name, "it holds no picture");
}

/** Decode the packets of a track; pictures come in the order in which they are shown. */
async function decode(
  track: Track,
  name: string,
  take: (picture: Picture, time: number) => void,
  frames: Frames,
  signal: AbortSignal,
): Promise<void> {
  const config = await supported(track, name);
  let colours: Colours | null = null;
  let failure: unknown = null;
  let waiting = 0;
  let work = Promise.resolve();
  const fail = (error: unknown): void => {
    failure ??= error;
  };
  const decoder = new VideoDecoder({
    output: (frame) => {
      waiting++;
      work = work.then(async () => {
        try {
          const time = frame.timestamp;
          const where = `${name}, frame ${frames.count}`;
          if (failure === null) take(await lumaOfFrame(frame, colours!, where), time);
        } catch (error) {
          fail(error);
        } finally {
          frame.close();
          waiting--;
        }
      });
    },
    error: ({ message }) => fail(damaged(`${name}, frame ${frames.count}`, message)),
  });
  const check = (): void => {
    if (failure !== null) throw failure;
  };
  try {
    decoder.configure(config);
    let begun = false;
    for await (const sample of track.samples()) {
      check();
      signal.throwIfAborted();
      begun ||= sample.key;
      if (!begun || sample.data.length === 0) continue; // nothing can be decoded before a key
      if (!colours) {
        colours = coloursOf(config.codec, track.rows, declaredColours(track, sample.data));
      } else if (config.codec.startsWith("vp09")) vp9Colours(sample.data);
      decoder.decode(chunk(sample));
      const since = performance.now();
      while (failure === null && (waiting > WAITING || decoder.decodeQueueSize > WAITING)) {
        await breathe(signal);
        if (performance.now() - since > PATIENCE) throw stuck(name);
      }
    }
    check();
    await Promise.race([decoder.flush(), patience(name)]);
    await work;
    check();
  } catch (error) {
    check(); // the reason behind it, if there is one
    if (!(error instanceof DOMException) || error.name === "AbortError") throw error;
    throw damaged(`${name}, frame ${frames.count}`, error.message);
  } finally {
    if (decoder.state !== "closed") decoder.close();
    await work;
  }
}

function chunk({ data, time, key }: Sample): EncodedVideoChunk {
  return new EncodedVideoChunk({ data, timestamp: time, type: key ? "key" : "delta" });
}

async function supported(track: Track, name: string): Promise<VideoDecoderConfig> {
  if (typeof VideoDecoder === "undefined") {
    const help = "Open the page from https or 127.0.0.1 in a browser of today, or convert it to .npy";
    throw notHere(name, "this browser gives pages no video decoder (WebCodecs)", help);
  }
  const refused = notHere(name, `this browser has no decoder for its video (${track.written})`, CONVERT);
  if (track.codec === null) throw refused;
  const config: VideoDecoderConfig = {
    codec: track.codec,
    codedWidth: track.cols,
    codedHeight: track.rows,
    ...(track.description ? { description: track.description } : {}),
  };
  // Software decoders give the same pictures everywhere, and do not run out of surfaces.
  for (const way of ["prefer-software", "no-preference"] as const) {
    const asked = { ...config, hardwareAcceleration: way };
    try {
      if ((await VideoDecoder.isConfigSupported(asked)).supported) return asked;
    } catch {
      throw refused;
    }
  }
  throw refused;
}

function patience(name: string): Promise<never> {
  return new Promise((_, reject) => setTimeout(() => reject(stuck(name)), PATIENCE));
}

function stuck(name: string): FramesError {
  return damaged(name, "the browser's decoder gave no picture for 30 s");
}

/** Return frames per second from the times of pictures; null for a single one. */
function rate(times: number[]): number | null {
  const ordered = Float64Array.from(times).sort();
  const span = ordered.length > 1 ? ordered[ordered.length - 1]! - ordered[0]! : 0;
  return span > 0 ? Math.round((1e9 * (ordered.length - 1)) / span) / 1000 : null;
}
