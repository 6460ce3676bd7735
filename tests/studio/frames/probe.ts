/** Answers questions about the page's frames, in Node or in a browser. */

import { bundledClips, loadBundled } from "../../../src/npchip/studio/page/frames/bundled";
import { type CameraStats, listCameras, openCamera } from "../../../src/npchip/studio/page/frames/camera";
import { drawnClip, type Drawing } from "../../../src/npchip/studio/page/frames/draw";
import { type Fit, FramesError, type Size, SizeError } from "../../../src/npchip/studio/page/frames/errors";
import { averageAreas } from "../../../src/npchip/studio/page/frames/fit";
import { luma } from "../../../src/npchip/studio/page/frames/luma";
import { openFiles } from "../../../src/npchip/studio/page/frames/open";
import { inOrder } from "../../../src/npchip/studio/page/frames/order";
import { encodeNpy } from "../../../src/npchip/studio/page/frames/save";
import type { Clip } from "../../../src/npchip/studio/page/protocol";

interface Question {
  ask: string;
  files?: { name: string; data: string }[];
  size?: [number, number];
  fit?: Fit | null;
  names?: string[];
  colours?: [number, number, number][];
  stopAfter?: number;
  drawing?: Drawing;
  seconds?: number;
  name?: string;
}

const ASKED: Record<string, (question: Question) => unknown> = {
  open,
  order: ({ names }) => inOrder(names!, (name) => name),
  luma: ({ colours }) => colours!.map(([red, green, blue]) => luma(red, green, blue)),
  save: async (question) => ({ data: coded(encodeNpy(await clip(question))) }),
  drawn: ({ drawing }) => shown(drawnClip(drawing!)),
  camera,
  averaging,
  bundled: async ({ name, size, fit }) => ({
    list: await bundledClips(),
    clip: shown(await loadBundled(name!, sized(size), fit ?? null)),
  }),
};

/** Answer a question; mistakes are answers too. */
async function probe(question: Question): Promise<unknown> {
  try {
    return await ASKED[question.ask]!(question);
  } catch (error) {
    if (error instanceof FramesError) {
      const croppable = error instanceof SizeError ? error.croppable : null;
      return { error: error.code, text: error.text, help: error.help, croppable };
    }
    const { name, message, stack } = error as Error;
    return { error: name, text: message, stack };
  }
}

function sized(size: [number, number] | undefined): Size {
  return { rows: size![0], cols: size![1] };
}

function clip({ files, size, fit, stopAfter }: Question): Promise<Clip> {
  const own = files!.map(({ name, data }) => {
    const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
    return new File([bytes], name);
  });
  const stop = new AbortController();
  let steps = 0;
  const count = (): void => {
    steps++;
    if (steps === stopAfter) stop.abort();
  };
  return openFiles(own, sized(size), fit ?? null, count, stop.signal);
}

async function open(question: Question): Promise<unknown> {
  return shown(await clip(question));
}

function shown({ name, count, rows, cols, data, fps }: Clip): unknown {
  return { name, shape: [count, rows, cols], fps, data: coded(data) };
}

/** Run the camera for some seconds; the frames' result is there at once. */
async function camera({ size, seconds, fit }: Question): Promise<unknown> {
  let [frames, brightest, longest] = [0, 0, 0];
  const take = async (frame: Uint8Array): Promise<void> => {
    frames++;
    brightest = Math.max(brightest, ...frame);
    await new Promise((resolve) => setTimeout(resolve, 5));
  };
  const began = performance.now();
  const opened = await openCamera(sized(size), take, fit ? { fit } : {});
  longest = performance.now() - began;
  await new Promise((resolve) => setTimeout(resolve, 1000 * seconds!));
  const stats: CameraStats = opened.stats();
  opened.stop();
  const before = frames;
  await new Promise((resolve) => setTimeout(resolve, 300));
  const cameras = await listCameras();
  return { ...stats, frames, brightest, opening: longest, after: frames - before, cameras };
}

/** Return milliseconds that a picture of 640 x 480 takes to be averaged. */
function averaging({ size }: Question): number {
  const data = new Uint8Array(480 * 640).map((_, at) => (at * 31) & 255);
  const times: number[] = [];
  for (let round = 0; round < 50; round++) {
    const began = performance.now();
    averageAreas({ rows: 480, cols: 640, data }, sized(size));
    times.push(performance.now() - began);
  }
  return times.sort((a, b) => a - b)[25]!;
}

function coded(data: Uint8Array): string {
  let text = "";
  for (let at = 0; at < data.length; at += 1 << 15) {
    text += String.fromCharCode(...data.subarray(at, at + (1 << 15)));
  }
  return btoa(text);
}

Object.assign(globalThis, { probe });
