/** The stepping form: goes to any instruction, forward, or back through a snapshot. */

import { Core, type Ended, type Sink } from "./core";
import { blocksByKey, type Form } from "./description";
import type { History, Moment } from "./history";
import type { Source } from "./source";

/**
 * Asked before instructions: how many cycles to go on before it is asked again; `EACH` for before
 * the next one, `STOP` to stop here. `moved` is false for the first question at a place where it
 * stood already.
 */
export type Guide = (block: number, moved: boolean) => number;
export const STOP = -1;
export const EACH = 0;

/** The reason for a halt: the guide said so; the run is over; or the next frame may not be taken. */
export type Outcome = "stopped" | "ended" | "waiting";

/** Decides if the next frame may be taken, by its number and the block that exposes it. */
export type Gate = (frame: number, block: number) => boolean;

export class Stepper extends Core {
  #guide: Guide = () => STOP;
  #gate: Gate | null = null;
  #start = 0;
  #stopped = false;
  #isOver = false;
  #held = false;
  readonly #blocks: Map<string, number>;
  /** The store for its snapshots; null for none. */
  history: History | null = null;

  constructor(form: Form, limit: number, source: Source, sink: Sink) {
    super(form, limit, source, sink);
    this.#blocks = blocksByKey(form.about);
  }

  /** Go to a snapshot. */
  restore(moment: Moment): void {
    const block = this.#blocks.get(moment.key);
    if (block === undefined) throw new Error(`no block ${moment.key} in the stepping form`);
    this.put(moment, block);
  }

  /** Go on as the guide says. With a gate, it takes the frames only that pass. */
  drive(guide: Guide, gate: Gate | null = null): Outcome {
    if (this.ended) return "ended";
    this.#guide = guide;
    this.#gate = gate;
    this.#start = this.time;
    this.#stopped = this.#isOver = this.#held = false;
    const { instance } = this;
    instance.setLong("check", 0);
    instance.setLong("first_check", 0);
    this.block = instance.run(this.block);
    this.take();
    if (this.#stopped) return "stopped";
    if (this.#held) return "waiting";
    this.ended = this.#end();
    return this.ended ? "ended" : "waiting";
  }

  protected override ask(request: number, block: number): number {
    const { requests } = this.instance.about;
    if (request === requests.tick) return this.#tick(block);
    if (request === requests.refill) return this.#refill(block);
    if (request === requests.drain) this.take();
    return 0; // there is no partner to receive from
  }

  #tick(block: number): number {
    const { instance } = this;
    const time = this.time;
    const next = this.#guide(block, time !== this.#start);
    if (this.history?.wants(time, this.frame, this.source.span)) {
      this.take();
      this.history.keep(this.capture(block));
    }
    if (next === STOP) {
      this.#stopped = true;
      return 1;
    }
    if (this.overLimit(block)) {
      this.#isOver = true;
      return 1;
    }
    if (next !== EACH) {
      const cycles = instance.long("cycles");
      const check = Math.min(cycles + next, Math.max(this.limit, cycles + 1));
      instance.setLong("check", check);
    }
    return 0;
  }

  #refill(block: number): number {
    const { instance, history, source } = this;
    this.take();
    if (this.broken) return 0;
    const next = instance.long("taken") + instance.word("available");
    if (this.#gate && !this.#gate(next, block)) {
      this.#held = true;
      return 0;
    }
    if (next >= source.count) return 0;
    if (history?.wants(this.time, this.frame, source.span)) history.keep(this.capture(block));
    this.fill(next, 1);
    instance.setLong("check", 0);
    return 1;
  }

  /** Return how the run ended before this block; null if a live frame may come. */
  #end(): Ended | null {
    const { here, instance, source } = this;
    const { exit } = here;
    if (this.#isOver) return { status: "cycle-limit", error: null };
    const failed = (code: string, address: number, message: string): Ended => ({
      status: "failed",
      error: { code, address, message: `at address ${address}: ${message}` },
    });
    if (exit?.status === "halted") {
      const cycles = instance.long("cycles") + (exit.cycles ?? 0);
      this.close(cycles, instance.long("instructions") + 1);
      this.halted = true;
    }
    if (this.broken) {
      const { code, address, message } = this.broken;
      return failed(code, address, message);
    }
    if (exit?.status === "halted") return { status: "halted", error: null };
    if (exit) return failed(exit.code ?? "", here.address, exit.message ?? "");
    if (here.port !== undefined) {
      return failed("NP306", here.address, `no partner has sent anything to port ${here.port}`);
    }
    return source.kind === "live" ? null : { status: "frames-exhausted", error: null };
  }
}
