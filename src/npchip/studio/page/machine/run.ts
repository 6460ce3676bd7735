/** A run at a pace, until a breakpoint, the end or a pause. */

import type { Pace, Stop } from "../protocol";
import type { Chip } from "./chip";
import { Watch } from "./conditions";
import { Forward } from "./forward";
import { type Breathe, type Past, SLICE } from "./past";
import { Pacer } from "./pacer";
import type { Pause, Sprinter } from "./sprinter";
import type { Stepper } from "./stepper";
import { endStop, hitStop, PAUSED } from "./travel";

const MOST_BACKOFF = 64;

export class Run {
  readonly #pacer: Pacer | null;
  readonly #unit: "steps" | "frames" | "max";
  /** First frame that the run form may try; where frames are long, it is tried less often. */
  #sprintAt = 0;
  #backoff = 1;
  #way: { chip: Stepper; breaks: unknown; forward: Forward } | null = null;

  constructor(
    private readonly chip: Chip,
    private readonly past: Past,
    pace: Pace,
    private readonly breathe: Breathe,
  ) {
    this.#pacer = pace === "max" ? null : new Pacer(pace.rate);
    this.#unit = pace === "max" ? "max" : pace.unit;
  }

  /** Run, and return why it stopped. */
  async go(): Promise<Stop> {
    const { chip } = this;
    try {
      for (;;) {
        const allowed = this.#pacer?.allowed() ?? Infinity;
        if (allowed > 0 && !chip.isAhead) {
          const stop = await this.#slice(allowed);
          if (stop) return stop;
        }
        chip.show();
        const wait = chip.isAhead ? Infinity : (this.#pacer?.wait ?? 0);
        if (wait > 1) {
          await chip.turns.sleep(Math.min(wait, chip.due));
        }
        if (await this.breathe()) return PAUSED;
      }
    } finally {
      if (chip.present.ended) chip.live.clear();
      else chip.live.rest();
    }
  }

  /** Go on for a slice of time; return why it stopped, or null. */
  async #slice(allowed: number): Promise<Stop | null> {
    const { chip, past } = this;
    const isFast = this.#unit !== "steps" && chip.breaks.length === 0;
    if (isFast && this.#toSprinter()) {
      const sprinter = chip.present as Sprinter;
      const before = sprinter.frame;
      const pause = sprinter.sprint(SLICE, this.#unit === "frames" ? allowed : Infinity);
      this.#pacer?.spend(sprinter.frame - before);
      return this.#paused(sprinter, pause);
    }
    if (await this.#waits()) return PAUSED;
    const stepper = chip.stepper();
    const way = this.#forward(stepper);
    const before = { time: stepper.time, frame: stepper.frame };
    if (this.#unit === "steps") way.goal.time = before.time + allowed;
    const arrival = way.slice(SLICE, (frame) => {
      if (isFast && frame >= this.#sprintAt) return false;
      return this.#unit !== "frames" || frame <= before.frame + allowed;
    });
    const done = this.#unit === "steps" ? stepper.time - before.time : stepper.frame - before.frame;
    this.#pacer?.spend(done);
    if (arrival === "hit") return hitStop(way.hit);
    if (arrival === "ended") return endStop(past, stepper);
    const isDry = arrival === "waiting" && stepper.frame + 1 >= past.source.count;
    if (isDry && (await chip.nextFrame(this.breathe))) return PAUSED;
    return null;
  }

  /** The movement of the stepping form; a new one when the breakpoints change. */
  #forward(stepper: Stepper): Forward {
    const { breaks } = this.chip;
    if (this.#way?.chip !== stepper || this.#way.breaks !== breaks) {
      const forward = new Forward(stepper, new Watch(stepper, breaks), {});
      this.#way = { chip: stepper, breaks, forward };
    }
    return this.#way.forward;
  }

  /** Wait for the stepping form; true if that is given up. */
  #waits(): Promise<boolean> {
    return this.past.steppable(() => {
      this.chip.flush();
      return this.breathe();
    });
  }

  /** See why the run form came to stand; return why the run stopped, or null. */
  async #paused(sprinter: Sprinter, pause: Pause): Promise<Stop | null> {
    const { chip, past } = this;
    if (pause === "held") return null;
    if (pause === "dry" && past.source.kind === "live") {
      return (await chip.nextFrame(this.breathe)) ? PAUSED : null;
    }
    if (pause === "off") {
      this.#sprintAt = sprinter.frame + this.#backoff;
      this.#backoff = Math.min(2 * this.#backoff, MOST_BACKOFF);
    } else this.#sprintAt = Infinity; // no frame is left
    if (await this.#waits()) {
      if (pause === "off") chip.present = past.again(sprinter);
      return PAUSED;
    }
    chip.present = past.handover(sprinter, pause, null);
    return null;
  }

  /** Change to the run form if that is possible here. */
  #toSprinter(): boolean {
    const { chip, past } = this;
    const { present } = chip;
    if ("sprint" in present) return true;
    if (present.ended || present.frame + 1 < this.#sprintAt) return false;
    if (present.time > 0 && !present.isBetween) return false;
    const sprinter = past.sprinter();
    if (present.time > 0 && !sprinter.restore(present.capture())) {
      this.#sprintAt = Infinity; // this form cannot begin here
      return false;
    }
    chip.present = sprinter;
    return true;
  }
}
