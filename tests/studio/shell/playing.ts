/** The player in a browser that answers when the test says: cameras, files, and a chip without life. */

import { deflateSync } from "node:zlib";

/** A stream of the camera: whether it is on. */
export interface Stream {
  on: boolean;
}

/** Streams that the browser has given. */
export const streams: Stream[] = [];
/** Readers who have not answered yet whether the page may have the camera. */
const asked: (() => void)[] = [];

/** The reader allows the camera, for the oldest question. */
export async function allow(): Promise<void> {
  asked.shift()?.();
  await settled();
}

/** Let all that is under way come to its end. */
export async function settled(): Promise<void> {
  for (let i = 0; i < 20; i++) await new Promise((resolve) => setImmediate(resolve));
}

function getUserMedia(): Promise<unknown> {
  return new Promise((resolve) => {
    asked.push(() => {
      const stream: Stream = { on: true };
      streams.push(stream);
      const track = { label: "", stop: () => (stream.on = false), addEventListener: () => undefined };
      resolve({ getTracks: () => [track], getVideoTracks: () => [track] });
    });
  });
}

/** Orders that the chip got. */
export const orders: string[] = [];

class Chip {
  onmessage: ((event: { data: unknown }) => void) | null = null;
  postMessage({ id, order }: { id: number; order: { to: string } }): void {
    orders.push(order.to);
    queueMicrotask(() => this.onmessage?.({ data: { of: "answer", id } }));
  }
  terminate(): void {}
}

const packed = (bytes: Uint8Array): string => deflateSync(bytes).toString("base64");
const data = {
  title: "t",
  program: { words: [], outputs: [], machine: { np_rows: 8, np_cols: 10 }, exposes: true },
  module: packed(new Uint8Array(8)),
  maxCycles: 1000,
  clip: { name: "own", count: 1, rows: 64, cols: 80, data: packed(new Uint8Array(5120)), fps: null },
};
const texts: Record<string, string> = { data: JSON.stringify(data), machine: '""' };
const video = { play: async () => undefined, requestVideoFrameCallback: () => undefined };
Object.assign(globalThis, {
  window: globalThis,
  isSecureContext: true,
  OffscreenCanvas: class {
    getContext(): object {
      let image = { data: new Uint8Array() };
      return {
        createImageData: (rows: number, cols: number) => ({ data: new Uint8Array(4 * rows * cols) }),
        putImageData: (given: typeof image) => (image = given),
        getImageData: () => image,
      };
    }
  },
  Worker: Chip,
  matchMedia: () => ({ matches: true }),
  document: {
    createElement: () => video,
    getElementById: (id: string) => ({ textContent: texts[id] }),
  },
});
Object.defineProperty(globalThis, "navigator", { value: { mediaDevices: { getUserMedia } } });
URL.createObjectURL = () => "blob:";
