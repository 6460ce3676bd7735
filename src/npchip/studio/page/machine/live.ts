/** Live frames on their way into the program: one that waits, one that is worked on. */

import type { LiveSource } from "./source";
import type { Turns } from "./turns";

type Answer = "done" | "dropped";

export class Live {
  #offered: { frame: Uint8Array; answer: (how: Answer) => void } | null = null;
  #taken: { index: number; answer: (how: Answer) => void } | null = null;

  constructor(private readonly turns: Turns) {}

  /** Offer a frame. Nobody wants it while the chip rests; a newer one takes its place. */
  offer(frame: Uint8Array): Promise<Answer> {
    return new Promise((resolve) => {
      this.#offered?.answer("dropped");
      this.#offered = null;
      if (!this.turns.isBusy) {
        resolve("dropped");
        return;
      }
      this.#offered = { frame, answer: resolve };
      this.turns.wake();
    });
  }

  /** Give the frame that waits to the source; false if there is none. */
  take(source: LiveSource): boolean {
    if (!this.#offered) return false;
    this.#taken?.answer("dropped");
    this.#taken = { index: source.count, answer: this.#offered.answer };
    source.push(this.#offered.frame);
    this.#offered = null;
    return true;
  }

  /** A frame is complete. */
  complete(index: number): void {
    if (this.#taken?.index !== index) return;
    this.#taken.answer("done");
    this.#taken = null;
  }

  /** The chip rests: what waits is out of date when it goes on. */
  rest(): void {
    this.#offered?.answer("dropped");
    this.#offered = null;
  }

  /** The chip is reset, or the run is over. */
  clear(): void {
    this.rest();
    this.#taken?.answer("dropped");
    this.#taken = null;
  }
}
