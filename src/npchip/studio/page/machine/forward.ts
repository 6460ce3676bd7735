/** A movement forward in the stepping form, cut into slices of time. */

import type { Block } from "./description";
import type { Hit, Watch } from "./conditions";
import { EACH, type Gate, STOP, type Stepper } from "./stepper";

/** The place at which a movement ends, unless a watch finds something before. */
export interface Goal {
  /** After so many instructions since the reset. */
  time?: number;
  /** Just after this frame was exposed. */
  frame?: number;
  /** Before a block, after at least one instruction. */
  at?: (block: Block) => boolean;
}

/** The end of a slice: `slice` if the time was up; `waiting` if no frame may be taken for now. */
export type Arrival = "goal" | "hit" | "ended" | "waiting" | "slice";

/** Cycles between two questions if nothing is watched. */
const STRIDE = 1 << 17;
/** Instructions between two looks at the clock if something is watched; a power of 2. */
const LOOK = 256;

export class Forward {
  /** The breakpoint or watch that was met, if any. */
  hit: Hit | null = null;
  #hasBegun = false;
  #previous = 0;
  #count = 0;

  constructor(
    private readonly chip: Stepper,
    private readonly watch: Watch,
    readonly goal: Goal,
  ) {}

  /** Go on for some milliseconds. */
  slice(milliseconds: number, gate: Gate | null = null): Arrival {
    const { chip, watch, goal } = this;
    const { blocks } = chip.instance.about;
    const isStepwise = !watch.isEmpty || goal.at !== undefined;
    const until = performance.now() + milliseconds;
    let arrival: Arrival = "slice";
    const isThere = (block: number): boolean => {
      this.hit = watch.after((blocks[this.#previous] as Block).address, block);
      if (this.hit) arrival = "hit";
      else if (goal.frame !== undefined && chip.frame >= goal.frame) arrival = "goal";
      else if (goal.at?.(blocks[block] as Block)) arrival = "goal";
      return arrival !== "slice";
    };
    const outcome = chip.drive((block, moved) => {
      if (!this.#hasBegun) {
        this.#hasBegun = true;
        watch.begin(block);
      } else if (moved && isThere(block)) {
        return STOP;
      }
      this.#previous = block;
      if (goal.time !== undefined && chip.time >= goal.time) {
        arrival = "goal";
        return STOP;
      }
      const looks = !isStepwise || (++this.#count & (LOOK - 1)) === 0;
      if (looks && performance.now() > until) return STOP;
      if (isStepwise) return EACH;
      return goal.time === undefined ? STRIDE : Math.min(STRIDE, goal.time - chip.time);
    }, gate);
    return outcome === "stopped" ? arrival : outcome;
  }
}
