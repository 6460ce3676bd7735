/** Drives the chip of the page: takes the orders of `page_chip.py`. */

import { readFileSync } from "node:fs";
import { Chip } from "../../../src/npchip/studio/page/machine/chip";
import { documents } from "../../../src/npchip/studio/page/machine/columns";
import type { ChipView, Clip, FrameDocument, Stop } from "../../../src/npchip/studio/page/protocol";
import { answering } from "../../support/answering";

const frames: FrameDocument[] = [];
const firsts: number[] = [];
const setups: FrameDocument[] = [];
let view: ChipView | null = null;
let stops: Stop[] = [];
let heard: ((stop: Stop) => void) | null = null;
let views = 0;

function forget(): void {
  frames.length = setups.length = 0;
}

const memory = JSON.parse(process.argv[2] ?? "{}") as { spacing?: number; budget?: number };
const chip = new Chip({
  frames(batch) {
    if (batch.first !== frames.length) throw new Error(`batch ${batch.first} came too late`);
    firsts.push(batch.first);
    if (batch.setup) setups.push(batch.setup);
    frames.push(...documents(batch));
    chip.taken();
  },
  view(seen) {
    view = seen;
    views++;
  },
  stopped(stop) {
    stops.push(stop);
    heard?.(stop);
  },
  progress: () => undefined,
  failed(message) {
    throw new Error(message);
  },
}, memory);

/** A file of NumPy: uint8 of shape (n, rows, columns). */
function readClip(path: string): Clip {
  const bytes = readFileSync(path);
  const start = 10 + bytes.readUInt16LE(8);
  const shape = /\((\d+), (\d+), (\d+)\)/.exec(bytes.toString("latin1", 10, start));
  const [count, rows, cols] = (shape ?? []).slice(1).map(Number) as [number, number, number];
  return { name: path, count, rows, cols, data: new Uint8Array(bytes.subarray(start)), fps: null };
}

const module = (path: string) => new Uint8Array(readFileSync(path));
const clipOf = (path: string | null) => (path ? readClip(path) : null);
const sleep = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

async function obey(order: any): Promise<unknown> {
  switch (order.do) {
    case "load":
      forget();
      return chip.load(module(order.module), order.program, order.limit);
    case "stepping": {
      const bring = () => chip.stepping(order.module && module(order.module), order.why ?? "");
      if (order.after) setTimeout(bring, order.after);
      else bring();
      return null;
    }
    case "frames":
      forget();
      return chip.frames(order.clip === "live" ? "live" : clipOf(order.clip));
    case "reset":
      forget();
      return chip.reset();
    case "breakpoints":
      return chip.breakpoints(order.all);
    case "run": {
      const stopped = new Promise<Stop>((resolve) => (heard = resolve));
      const started = performance.now();
      void chip.run(order.pace);
      let pausedAt = 0;
      if (order.pause !== undefined) {
        await sleep(order.pause);
        pausedAt = performance.now();
        chip.pause();
      }
      const stop = await stopped;
      const now = performance.now();
      return { stop, took: now - started, latency: now - pausedAt };
    }
    case "go": {
      const started = performance.now();
      const stop = await chip.go(order.travel, order.back ?? false);
      return { stop, took: performance.now() - started };
    }
    case "view":
      return plain(view as ChipView);
    case "outputs":
      return { frames, firsts, setups, views, stops: stops.length };
    case "wrote":
      return chip.wrote(order.value, order.writers);
    case "profile":
      return Array.from(await chip.profile(order.frame));
    case "whole":
      return chip.whole(module(order.module), clipOf(order.clip), order.limit);
    case "live": {
      // Feed frames of a clip as a camera would, and say how each of them fared.
      const clip = readClip(order.clip);
      const size = clip.rows * clip.cols;
      const run = order.run ? chip.run("max") : null;
      const answers: string[] = [];
      for (let i = order.first; i < order.first + order.count; i++) {
        await sleep(order.wait ?? 0);
        const at = (i % clip.count) * size;
        const fed = chip.feed(clip.data.slice(at, at + size));
        answers.push(await (run ? Promise.race([fed, run.then(() => "the run ended")]) : fed));
      }
      if (run) {
        chip.pause();
        await run;
      }
      return answers;
    }
  }
  throw new Error(`no order ${order.do}`);
}

function plain(seen: ChipView): unknown {
  return JSON.parse(
    JSON.stringify(seen, (_, value) => (value instanceof Uint8Array ? Array.from(value) : value)),
  );
}

await answering(obey);
