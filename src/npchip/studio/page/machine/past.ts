/** A run with its past: makes chips and puts them at moments. */

import type { Sink } from "./core";
import { type Forms, keyOf } from "./description";
import { Forward } from "./forward";
import { History, type Moment } from "./history";
import type { Source } from "./source";
import { type Pause, Sprinter } from "./sprinter";
import { Stepper } from "./stepper";
import { Watch } from "./conditions";

const NOBODY: Sink = { frame: () => undefined, frames: () => undefined };
/** Milliseconds of work between two looks at the messages. */
export const SLICE = 12;

/** Lets messages in; true if the work is to be given up. */
export type Breathe = () => Promise<boolean>;

export class Past {
  readonly history: History;

  constructor(
    readonly forms: Forms,
    readonly limit: number,
    readonly source: Source,
    readonly sink: Sink,
    history: (beginning: Moment) => History = (beginning) => new History(beginning),
  ) {
    this.history = history({
      time: 0,
      baseTime: 0,
      baseCycles: 0,
      frame: -1,
      closed: 0,
      last: { cycles: 0, instructions: 0 },
      key: keyOf(forms.run.about.blocks[0] ?? { address: 0 }),
      within: true,
      sends: null,
      state: null,
    });
  }

  sprinter(): Sprinter {
    return new Sprinter(this.forms.run, this.limit, this.source, this.sink, this.history);
  }

  /** A chip at the beginning whose frames count. */
  stepper(): Stepper {
    const stepper = new Stepper(this.forms.step, this.limit, this.source, this.sink);
    stepper.history = this.history;
    return stepper;
  }

  /** A chip for looking around, which leaves no traces. */
  scout(): Stepper {
    return new Stepper(this.forms.step, this.limit, this.source, NOBODY);
  }

  /** Wait for the stepping form, which may not have come yet; true if that is given up. */
  async steppable(breathe: Breathe): Promise<boolean> {
    while (!(await this.forms.arrives(SLICE))) if (await breathe()) return true;
    return false;
  }

  /** A run form instead of one that is off, where that was last sound. */
  again(sprinter: Sprinter): Sprinter {
    const moment = this.history.before(sprinter.baseTime);
    const other = this.sprinter();
    // If it cannot begin there, it repeats the run from the start: no frame is reported twice.
    if (moment.state) other.restore(moment);
    return other;
  }

  /** Put a chip at a snapshot; it may be another chip then. */
  put(chip: Stepper, moment: Moment): Stepper {
    if (!moment.state) {
      if (chip.time === 0 && chip.closed === 0 && !chip.ended) return chip;
      return chip.history ? this.stepper() : this.scout();
    }
    chip.restore(moment);
    return chip;
  }

  /** Put a chip at the last snapshot before a time, unless it is nearer. */
  near(chip: Stepper, time: number): Stepper {
    const moment = this.history.before(time);
    if (moment.time <= chip.time && chip.time <= time) return chip;
    return this.put(chip, moment);
  }

  /** Go to a moment; to the oldest in reach if it is too far back, or less far if given up. */
  async seek(chip: Stepper, time: number, breathe: Breathe): Promise<Stepper> {
    const there = this.near(chip, time);
    const way = new Forward(there, new Watch(there, []), { time });
    while (way.slice(SLICE) === "slice") if (await breathe()) break;
    return there;
  }

  /** Let the stepping form take over from the run form. */
  handover(sprinter: Sprinter, pause: Pause, stepper: Stepper | null): Stepper {
    // If the run form is off, its state cannot be had, or is too late.
    const isSound = pause !== "off";
    const moment = isSound ? sprinter.capture() : this.history.before(sprinter.baseTime);
    return this.put(stepper ?? this.stepper(), moment);
  }
}
