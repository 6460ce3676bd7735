/** Steps or frames that a pace allows by now. */

/** Seconds of work that may be caught up with after a hiccup. */
const BACKLOG = 0.1;

export class Pacer {
  #saved = 1;
  #at = performance.now();

  /** Steps or frames a second. */
  constructor(private readonly rate: number) {}

  /** Whole steps or frames that may be done now. */
  allowed(): number {
    const now = performance.now();
    const more = ((now - this.#at) / 1000) * this.rate;
    this.#at = now;
    this.#saved = Math.min(this.#saved + more, Math.max(1, this.rate * BACKLOG));
    return Math.floor(this.#saved);
  }

  spend(count: number): void {
    this.#saved -= count;
  }

  /** Milliseconds until the next one. */
  get wait(): number {
    return Math.max(0, ((1 - this.#saved) / this.rate) * 1000);
  }
}
