/** The run form: goes over whole frames, as many at a time as fit a slice. */

import { Core, type Sink } from "./core";
import { blocksByKey, type Form } from "./description";
import type { History, Moment } from "./history";
import type { Source } from "./source";

/**
 * The reason for a halt. `held`: before a frame, and it can go on; `dry`: the same, but there is no
 * frame; `off`: the stepping form has to find the exact end from the last snapshot, and this
 * instance must not go on.
 */
export type Pause = "held" | "dry" | "off";

/** Milliseconds that frames in the ring may take before it gives up. */
const PATIENCE = 25;
/** Milliseconds that the frames of one refill should take. */
const GOAL = 4;
/** Bytes of frames in the ring, so that they stay in the processor's cache: twice as fast. */
const CACHED = 1 << 17;
/** Cycles between two looks at the clock. */
const LOOK = 1_000_000;

export class Sprinter extends Core {
  #frames = 0; // that it may still take in this slice
  #until = 0; // time by the clock
  #ringAt = 0;
  #ring = 1; // frames to put into the ring
  readonly #most: number;
  #isOff = false;
  #pause: Pause = "held";
  readonly #history: History;
  readonly #blocks: Map<string, number>;

  constructor(form: Form, limit: number, source: Source, sink: Sink, history: History) {
    super(form, limit, source, sink);
    const { capacity, bytes } = form.about.frames;
    this.#most = Math.min(capacity, Math.max(1, Math.floor(CACHED / bytes)));
    this.#history = history;
    this.#blocks = blocksByKey(form.about);
  }

  /** Go to a snapshot taken before a frame; false if this form cannot begin there. */
  restore(moment: Moment): boolean {
    const block = this.#blocks.get(moment.key) ?? -1;
    if (block < 0 || moment.within || !moment.state) return false;
    this.put(moment, block);
    return true;
  }

  /** Run for some milliseconds, or a number of frames. */
  sprint(milliseconds: number, frames = Infinity): Pause {
    const { instance } = this;
    this.#ringAt = performance.now();
    this.#until = this.#ringAt + milliseconds;
    this.#frames = frames;
    this.#pause = "held";
    const check = Math.min(this.limit, LOOK);
    instance.setLong("check", check);
    instance.setLong("first_check", check);
    this.block = instance.run(this.block);
    const isAtFrame = this.here.exposes === true && !this.#isOff;
    if (!isAtFrame || this.overLimit(this.block) || this.broken) return "off";
    return this.#pause;
  }

  protected override ask(request: number, block: number): number {
    const { requests } = this.instance.about;
    if (request === requests.tick) return this.#tick(block);
    if (request === requests.refill) return this.#refill(block);
    if (request === requests.drain) this.take();
    return 0;
  }

  #tick(block: number): number {
    if (this.overLimit(block) || performance.now() - this.#ringAt > PATIENCE) {
      this.#isOff = true;
      return 1;
    }
    const cycles = this.instance.long("cycles");
    this.instance.setLong("check", Math.max(cycles + 1, Math.min(cycles + LOOK, this.limit)));
    return 0;
  }

  #refill(block: number): number {
    this.take();
    if (this.broken) return 0;
    const { instance, source } = this;
    const now = performance.now();
    const taken = now - this.#ringAt;
    const had = instance.word("available");
    if (taken < GOAL / 2 && had === this.#ring) {
      this.#ring = Math.min(2 * this.#ring, this.#most);
    } else if (taken > GOAL) this.#ring = Math.max(1, this.#ring >> 1);
    const next = instance.long("taken") + had;
    const count = Math.min(this.#ring, this.#frames, source.count - next);
    if (count < 1) {
      this.#pause = source.count <= next ? "dry" : "held";
      return 0;
    }
    if (now >= this.#until) return 0;
    if (this.#history.wants(this.time, this.frame, source.span)) {
      this.#history.keep(this.capture(block));
    }
    this.#frames -= count;
    this.fill(next, count);
    this.#ringAt = now;
    return 1;
  }
}
