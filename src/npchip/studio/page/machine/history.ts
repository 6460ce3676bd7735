/** The past of a run: snapshots from which any moment can be reached again. */

import type { PortSends } from "./sends";

/**
 * A snapshot. Time is the number of instructions executed since the reset; the program and its
 * frames determine every moment, so it is all that names one.
 */
export interface Moment {
  time: number;
  /** Instructions and cycles of the frames before the present one. */
  baseTime: number;
  baseCycles: number;
  /** The exposed frame; -1 in the setup. */
  frame: number;
  /** Frames that have been closed; 0 in the setup. */
  closed: number;
  /** Cycles and instructions of the frame that was closed last. */
  last: { cycles: number; instructions: number };
  /** Key of the block, as both forms know it. */
  key: string;
  /** True within a frame, false before the exposure of one. */
  within: boolean;
  sends: PortSends[] | null;
  /** Bytes to write into an instance; null for one that is new. */
  state: Uint8Array<ArrayBuffer> | null;
}

const BUDGET = 64 << 20;
const SPACING = 1 << 20;

/** Snapshots in order of time. The first one, the beginning, is always there if frames are. */
export class History {
  /** Instructions between two snapshots; grows as the run does. */
  spacing: number;
  readonly #moments: Moment[] = [];
  #bytes = 0;

  constructor(
    beginning: Moment,
    spacing = SPACING,
    private readonly budget = BUDGET,
  ) {
    this.spacing = spacing;
    this.keep(beginning);
  }

  /** Return whether a snapshot is due. */
  wants(time: number, frame: number, span: number): boolean {
    const last = this.before(time);
    return time - last.time >= this.spacing || frame - last.frame >= span;
  }

  keep(moment: Moment): void {
    const at = this.#after(moment.time);
    const same = this.#moments[at - 1];
    if (same?.time === moment.time) return;
    this.#moments.splice(at, 0, moment);
    this.#bytes += sizeOf(moment);
    if (this.#bytes > this.budget && this.#moments.length > 2) this.#thin();
  }

  /** Forget every other one but the first, and take them half as often from now on. */
  #thin(): void {
    this.spacing *= 2;
    const kept = this.#moments.filter((_, index) => index % 2 === 0);
    this.#moments.splice(0, this.#moments.length, ...kept);
    this.#bytes = kept.reduce((sum, moment) => sum + sizeOf(moment), 0);
  }

  /** Forget those that need frames older than this. */
  forget(oldest: number): void {
    let count = 0;
    const { length } = this.#moments;
    while (count < length - 1 && needs(this.#moments[count] as Moment) < oldest) count++;
    for (const moment of this.#moments.splice(0, count)) this.#bytes -= sizeOf(moment);
  }

  /** The last snapshot at or before a time; the oldest one if there is none. */
  before(time: number): Moment {
    return (this.#moments[this.#after(time) - 1] ?? this.#moments[0]) as Moment;
  }

  get oldest(): Moment {
    return this.#moments[0] as Moment;
  }

  /** The snapshots before a time, the newest first. */
  until(time: number): Moment[] {
    return this.#moments.filter((moment) => moment.time < time).reverse();
  }

  /** Index of the first snapshot after a time. */
  #after(time: number): number {
    let [low, high] = [0, this.#moments.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.#moments[middle] as Moment).time <= time) low = middle + 1;
      else high = middle;
    }
    return low;
  }
}

/** The first frame that a snapshot needs: the one that the chip shows there. */
function needs(moment: Moment): number {
  return Math.max(0, moment.frame);
}

function sizeOf(moment: Moment): number {
  const sends = moment.sends ?? [];
  const sent = sends.reduce((sum, port) => sum + port.planes.length + port.list.length, 0);
  return 512 + (moment.state?.length ?? 0) + sent;
}
