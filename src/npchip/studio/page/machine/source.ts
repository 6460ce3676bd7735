/** Sources of frames: none, a clip, or a camera whose last frames are kept. */

import type { Clip } from "../protocol";

/** Frames by their number since the reset. */
export interface Source {
  /** Kind of source, for messages. */
  readonly kind: "none" | "clip" | "live";
  /** The oldest frame that can still be had. */
  readonly oldest: number;
  /** Frames that there are up to now. */
  readonly count: number;
  /** Most frames that may lie between two snapshots, so that one is always in reach. */
  readonly span: number;
  get(number: number): Uint8Array;
  /** Copy frames to a place. */
  copy(first: number, count: number, target: Uint8Array, at: number): void;
}

const SPAN = 4096;

/** No frames. */
export const NOTHING: Source = {
  kind: "none",
  oldest: 0,
  count: 0,
  span: SPAN,
  get: () => {
    throw new Error("no frames were given");
  },
  copy: () => undefined,
};

/** The frames of a clip. */
export class ClipSource implements Source {
  readonly kind = "clip";
  readonly oldest = 0;
  readonly count: number;
  readonly span = SPAN;
  readonly #data: Uint8Array;
  readonly #bytes: number;

  constructor(clip: Clip) {
    this.count = clip.count;
    this.#bytes = clip.rows * clip.cols;
    this.#data = clip.data;
  }

  get(number: number): Uint8Array {
    return this.#data.subarray(number * this.#bytes, (number + 1) * this.#bytes);
  }

  copy(first: number, count: number, target: Uint8Array, at: number): void {
    target.set(this.#data.subarray(first * this.#bytes, (first + count) * this.#bytes), at);
  }
}

const KEPT_BYTES = 16 << 20;

/** Live frames: a ring of the last ones, so that the chip can go back a while. */
export class LiveSource implements Source {
  readonly kind = "live";
  count = 0;
  readonly span: number;
  readonly #kept: Uint8Array[] = [];
  readonly #most: number;

  constructor(bytes: number) {
    this.#most = Math.max(16, Math.floor(KEPT_BYTES / bytes));
    this.span = Math.max(1, this.#most >> 3);
  }

  get oldest(): number {
    return Math.max(0, this.count - this.#most);
  }

  push(frame: Uint8Array): void {
    this.#kept[this.count % this.#most] = frame;
    this.count++;
  }

  get(number: number): Uint8Array {
    const frame = this.#kept[number % this.#most];
    if (!frame || number < this.oldest) throw new Error(`frame ${number} is no longer kept`);
    return frame;
  }

  copy(first: number, count: number, target: Uint8Array, at: number): void {
    for (let i = 0; i < count; i++) {
      const frame = this.get(first + i);
      target.set(frame, at + i * frame.length);
    }
  }
}
