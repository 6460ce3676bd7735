/**
 * What the shell finds around it in a browser, as far as it needs it to run programs: files, and a
 * chip whose worker is here. Whatever is asked for answers late, in an order drawn from a seed; of
 * the chip's messages none overtakes another. Its clock jumps, as on a busy computer.
 */

import { readFileSync } from "node:fs";
import { join } from "node:path";

const folder = process.argv[2] ?? ".";
let state = 1;
/** Milliseconds by which the clock may jump. */
let jump = 10;

/** A number of at least 0 and below 1. */
export function random(): number {
  state = (state + 0x6d2b79f5) | 0;
  let t = Math.imul(state ^ (state >>> 15), 1 | state);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
}

export function below(end: number): number {
  return Math.floor(random() * end);
}

export function draw<T>(from: readonly T[]): T {
  return from[below(from.length)] as T;
}

export function seeded(seed: number): void {
  state = seed * 7919 + 1;
  jump = draw([0.1, 2, 10, 40]);
}

/** Wait for some turns of the event loop. */
export async function turns(count: number): Promise<void> {
  for (let i = 0; i < count; i++) await new Promise((resolve) => setImmediate(resolve));
}

/** Delivers messages late and in order. */
function channel(deliver: (data: unknown) => void): (data: unknown) => void {
  let last: Promise<unknown> = Promise.resolve();
  return (data) => {
    const copy: unknown = structuredClone(data);
    const wait = random() < 0.5 ? 0 : below(12);
    last = last.then(() => turns(wait)).then(() => void deliver(copy));
  };
}

type Port = { onmessage: ((event: { data: unknown }) => unknown) | null };

/** The global scope of the chip's worker. */
const inside: Port & { postMessage(data: unknown): void } = {
  onmessage: null,
  postMessage: (data) => toPage(data),
};
let page: Port | null = null;
const toPage = channel((data) => page?.onmessage?.({ data }));
const toChip = channel((data) => inside.onmessage?.({ data }));

/** Only the chip's worker answers: no assembler is needed for programs that were translated. */
class LateWorker implements Port {
  onmessage: Port["onmessage"] = null;
  readonly #isChip: boolean;

  constructor(_url: URL, { name }: { name: string }) {
    this.#isChip = name === "chip";
    if (this.#isChip) page = this;
  }

  postMessage(data: unknown): void {
    if (this.#isChip) toChip(data);
  }

  terminate(): void {
    if (this.#isChip) throw new Error("the chip was ended, though it answers");
  }
}

async function fetched(path: string | URL): Promise<unknown> {
  await turns(below(60));
  const name = String(path).replace("http://page/", "");
  const bytes = readFileSync(join(folder, name));
  return {
    ok: true,
    json: async () => JSON.parse(bytes.toString()) as unknown,
    arrayBuffer: async () => new Uint8Array(bytes).buffer,
  };
}

let clock = 0;
performance.now = () => (clock += random() < 0.3 ? random() * jump : 0.01);

const later = globalThis.setTimeout;
/** What waits longer than a moment: it goes off in `elapse` only. */
const long: (() => void)[] = [];

/** Let so much time go by that all that waits for long goes off. */
export function elapse(): void {
  for (const then of long.splice(0)) then();
}

Object.assign(globalThis, {
  self: inside,
  document: { baseURI: "http://page/" },
  location: { hash: "", pathname: "/", search: "" },
  history: { replaceState: () => undefined },
  localStorage: { getItem: () => null, setItem: () => undefined, removeItem: () => undefined },
  sessionStorage: { getItem: () => null, setItem: () => undefined, removeItem: () => undefined },
  Worker: LateWorker,
  fetch: fetched,
  // Short sleeps are as short as can be.
  setTimeout: (then: () => void, ms = 0) => {
    if (ms >= 100) return long.push(then);
    return later(() => {
      clock += ms;
      then();
    }, 0);
  },
});
