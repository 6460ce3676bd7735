/** Drives the client of the chip as the page does, with a worker of Node in place of a browser's. */

import { readFileSync } from "node:fs";
import { Worker as Thread } from "node:worker_threads";
import { createChip } from "../../../src/npchip/studio/page/machine/client";
import type { Clip, ProgramInfo, Stop } from "../../../src/npchip/studio/page/protocol";

const [, , worker = "", modulePath = "", endlessPath = "", clipPath = ""] = process.argv;
const bytes = (path: string) => new Uint8Array(readFileSync(path));
const program = { words: [] as unknown[] } as ProgramInfo;

/** The worker's file expects a browser's global scope. */
const PRELUDE = `
const { parentPort } = require("node:worker_threads");
globalThis.self = globalThis;
globalThis.postMessage = (message, handOver) => parentPort.postMessage(message, handOver);
import(${JSON.stringify(`file://${worker}`)}).then(() => {
  parentPort.on("message", (data) => globalThis.onmessage({ data }));
});
`;

function makeWorker(): Worker {
  const thread = new Thread(PRELUDE, { eval: true });
  const shape = {
    onmessage: null as ((event: { data: unknown }) => void) | null,
    onerror: null as ((event: { message: string; preventDefault(): void }) => void) | null,
    postMessage: (message: unknown, handOver: ArrayBuffer[]) =>
      thread.postMessage(message, handOver),
    terminate: () => void thread.terminate(),
  };
  thread.on("message", (data) => shape.onmessage?.({ data }));
  thread.on("error", ({ message }) => shape.onerror?.({ message, preventDefault: () => undefined }));
  return shape as unknown as Worker;
}

/** What was told since an order to begin anew, which drops all that is of before. */
const since: string[] = [];
const firsts: [number, number][] = [];
const faults: string[] = [];
let valid: number[] = [];
let heard: (stop: Stop) => void = () => undefined;
let seen = 0;
const chip = createChip(makeWorker, {
  begun: () => void since.splice(0),
  frames(batch) {
    since.push(`frames from ${batch.first}`);
    firsts.push([batch.first, batch.cycles.length]);
    const column = batch.outputs.valid;
    if (column?.kind === "scalar") valid.push(...column.values);
  },
  view(view) {
    since.push(`view at ${view.instructions}`);
    seen = view.instructions;
  },
  stopped(stop) {
    since.push(stop.reason);
    heard(stop);
  },
  progress: () => undefined,
  failed: (message) => faults.push(message),
});

async function run(pause?: number): Promise<Stop> {
  const stopped = new Promise<Stop>((resolve) => (heard = resolve));
  chip.run("max");
  if (pause !== undefined) setTimeout(() => chip.pause(), pause);
  return stopped;
}

const told: Record<string, unknown> = {};
const data = bytes(clipPath).slice(128);
const clip: Clip = { name: "c", count: data.length / 5120, rows: 64, cols: 80, data, fps: null };
await chip.load(bytes(modulePath), program, 1e6);
await chip.frames(clip);
told.first = await run();
told.valid = valid;
told.whole = (await chip.whole(bytes(modulePath), program, clip, 1e6)).cycles;
told.small = await chip.frames({ ...clip, name: "small", rows: 32 }).catch((e: Error) => e.message);
told.rest = await chip.feed(new Uint8Array(5120));
await chip.load(bytes(endlessPath), program, 1e12);
told.paused = await run(100);
const going = chip.go({ to: "end" }, false).catch((e: Error) => e.message);
setTimeout(() => chip.terminate(), 100);
told.ended = await going;
told.empty = await chip.reset().catch((e: Error) => e.message);
valid = [];
firsts.length = 0;
await chip.load(bytes(modulePath), program, 1e6); // the clip is known to the new worker
told.again = await run();
told.same = JSON.stringify(valid) === JSON.stringify(told.valid);
told.firsts = [...firsts];
told.back = await chip.go({ to: "end" }, true);
told.seen = seen;
// Nothing of a run that is cut short is told after the order that did it.
const many: Clip = { ...clip, count: 4_000, data: new Uint8Array(4_000 * 5120) };
await chip.frames(many);
const anew: string[][] = [];
for (let i = 0; i < 5; i++) {
  seen = 0;
  chip.run({ unit: "frames", rate: 2_000 });
  while (!seen) await new Promise((resolve) => setTimeout(resolve, 3));
  await chip.reset();
  anew.push([...since]);
}
told.anew = anew;
let stops = 0;
heard = () => stops++;
chip.run({ unit: "frames", rate: 1 });
chip.run({ unit: "frames", rate: 1 });
await new Promise((resolve) => setTimeout(resolve, 300));
told.stops = stops;
console.log(JSON.stringify({ ...told, faults }));
process.exit(0);
