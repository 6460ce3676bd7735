/** Takes orders one after the other, lets messages in while it works, and hears `stop`. */

import type { Breathe } from "./past";

/**
 * Waits for the messages that have come: timers would wait 4 ms, a promise would let none in. It
 * keeps its channels, as to make one takes a browser longer than to use it. They take turns, since
 * Node delivers up to a thousand messages of one channel before it looks at anything else.
 */
class Doorway {
  readonly #channels: MessageChannel[] = [];
  #turn = 0;

  letIn(): Promise<void> {
    this.#turn ^= 1;
    const { port1, port2 } = (this.#channels[this.#turn] ??= new MessageChannel());
    return new Promise((resolve) => {
      port2.addEventListener("message", () => resolve(), { once: true });
      port2.start();
      port1.postMessage(null);
    });
  }

  /** An open channel would keep Node alive. */
  close(): void {
    for (const channel of this.#channels) channel?.port1.close();
  }
}

export class Turns {
  #queue: Promise<unknown> = Promise.resolve();
  #given = 0;
  #stopped = 0;
  /** The newest run. */
  #run = 0;
  #wake: (() => void) | null = null;
  /** The order at work; 0 for none. */
  #current = 0;

  get isBusy(): boolean {
    return this.#current > 0;
  }

  /** Do something when all orders before it are done. It stops a run, which may have no end. */
  order<T>(work: (breathe: Breathe) => Promise<T>, isRun = false): Promise<T> {
    const ticket = ++this.#given;
    this.#stopped = Math.max(this.#stopped, this.#run);
    if (isRun) this.#run = ticket;
    this.wake();
    const done = this.#queue.then(async () => {
      this.#current = ticket;
      const doorway = new Doorway();
      try {
        return await work(async () => {
          await doorway.letIn();
          return this.#stopped >= ticket;
        });
      } finally {
        doorway.close();
        this.#current = 0;
      }
    });
    this.#queue = done.catch(() => undefined);
    return done;
  }

  /** Do something beside the orders, which does not stop them. */
  async aside<T>(work: (breathe: Breathe) => Promise<T>): Promise<T> {
    const doorway = new Doorway();
    try {
      return await work(async () => {
        await doorway.letIn();
        return false;
      });
    } finally {
      doorway.close();
    }
  }

  /** Stop all orders that were given up to now. */
  stop(): void {
    this.#stopped = this.#given;
    this.wake();
  }

  /** Sleep some milliseconds, or until `wake`. */
  sleep(milliseconds: number): Promise<void> {
    return new Promise((resolve) => {
      const timer = Number.isFinite(milliseconds) ? setTimeout(done, milliseconds) : undefined;
      this.#wake = done;
      function done(): void {
        clearTimeout(timer);
        resolve();
      }
    });
  }

  /** End a sleep: something has come that may matter. */
  wake(): void {
    this.#wake?.();
    this.#wake = null;
  }
}
