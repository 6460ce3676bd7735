/** A form at work at one moment of a run: what the stepping form and the run form share. */

import type { ChipView, RunDocument } from "../protocol";
import { type Alike, AlikeFrames, RECORD } from "./alike";
import { type Block, type Form, keyOf } from "./description";
import type { Moment } from "./history";
import { Instance } from "./instance";
import { type Broken, Sends } from "./sends";
import type { Source } from "./source";

/** Takes complete frames. `index` is -1 for the setup. */
export interface Sink {
  frame(index: number, cycles: number, instructions: number, sends: Sends): void;
  /** Takes several frames at once, from `index` on; never the setup. */
  frames(index: number, alike: Alike): void;
}

/** The end of a run. */
export interface Ended {
  status: RunDocument["status"];
  error: NonNullable<RunDocument["error"]> | null;
}

export abstract class Core {
  readonly instance: Instance;
  readonly sends: Sends;
  /** The block before which it stands. */
  block = 0;
  /** Instructions and cycles of the frames before the present one. */
  baseTime = 0;
  baseCycles = 0;
  /** Frames that have been closed, the setup included. */
  closed = 0;
  #lastCycles = 0;
  #lastInstructions = 0;
  /** The first rule that a complete frame broke, which ends the run. */
  broken: Broken | null = null;
  ended: Ended | null = null;
  /** True if the `HALT` before which it stands has been executed. */
  halted = false;
  /** Addresses up to which the log was taken. */
  #log: number;
  #data: number;
  readonly #alike: AlikeFrames;

  constructor(
    form: Form,
    readonly limit: number,
    readonly source: Source,
    readonly sink: Sink,
  ) {
    const instance = new Instance(form);
    this.instance = instance;
    this.sends = new Sends(instance.about);
    this.#alike = new AlikeFrames(instance);
    const { about } = instance;
    this.#log = about.log;
    this.#data = about.data;
    instance.ask = (request, block) => this.ask(request, block);
    instance.emptyLog();
    instance.setWord("frame", about.frames.first);
  }

  protected abstract ask(request: number, block: number): number;

  get here(): Block {
    return this.blockAt(this.block);
  }

  protected blockAt(block: number): Block {
    return this.instance.about.blocks[block] as Block;
  }

  /** The frame that was closed last. */
  get last(): { cycles: number; instructions: number } {
    return { cycles: this.#lastCycles, instructions: this.#lastInstructions };
  }

  /** Index of the exposed frame; -1 before the first. */
  get frame(): number {
    const { instance } = this;
    return instance.long("taken") + instance.word("position") - 1;
  }

  /** Instructions since the reset. */
  get time(): number {
    return this.baseTime + (this.halted ? 0 : this.instance.long("instructions"));
  }

  /** Cycles since the reset. */
  get cycles(): number {
    return this.baseCycles + (this.halted ? 0 : this.instance.long("cycles"));
  }

  /** Cycles of the frame that the chip shows: between two frames, of the one that was closed. */
  get frameCycles(): number {
    return this.isClosed ? this.last.cycles : this.instance.long("cycles");
  }

  get frameInstructions(): number {
    return this.isClosed ? this.last.instructions : this.instance.long("instructions");
  }

  /** True if the frame that the chip shows was closed. */
  protected get isClosed(): boolean {
    return this.halted || this.isBetween;
  }

  /** True if a frame was closed and none has begun. */
  get isBetween(): boolean {
    return this.closed > this.frame + 1;
  }

  protected overLimit(block: number): boolean {
    const cycles = this.instance.long("cycles");
    return cycles > this.limit || (cycles === this.limit && !this.blockAt(block).exposes);
  }

  /** Take the sends and the complete frames out of the log. */
  protected take(): void {
    const { instance } = this;
    const { words, about } = instance;
    const count = instance.word("closed");
    const first = this.#takeAlike(count);
    for (let i = first, record = about.records + first * RECORD; i < count; i++, record += RECORD) {
      this.#takeTo(words[(record + 16) >>> 2] as number);
      this.close(instance.longAt(record), instance.longAt(record + 8));
    }
    const end = instance.word("log_end");
    if (end !== this.#log) this.#takeTo(end);
    instance.emptyLog();
    this.#log = about.log;
    this.#data = about.data;
  }

  /** Take the first frames of a batch at once if they allow it; return how many. */
  #takeAlike(closed: number): number {
    const { instance, source } = this;
    const isBegun = this.#log !== instance.about.log || !this.sends.empty;
    // A live frame comes alone, and the page wants its pixels back.
    if (isBegun || this.broken || this.closed === 0 || source.kind === "live") return 0;
    const alike = this.#alike.find(closed);
    if (!alike) return 0;
    const { count, record } = alike;
    this.sink.frames(this.closed - 1, alike);
    for (let at = record, i = 0; i < count; i++, at += RECORD) {
      this.#lastCycles = instance.longAt(at);
      this.#lastInstructions = instance.longAt(at + 8);
      this.baseCycles += this.#lastCycles;
      this.baseTime += this.#lastInstructions;
    }
    this.closed += count;
    this.#log += 4 * count * alike.each;
    return count;
  }

  #takeTo(end: number): void {
    if (end === this.#log) return;
    if (!this.broken) this.#data = this.sends.take(this.instance, this.#log, end, this.#data);
    this.#log = end;
  }

  /** Close a frame whose sends were taken. One without instructions never was. */
  protected close(cycles: number, instructions: number): void {
    if (this.broken || (this.closed > 0 && instructions === 0)) return;
    this.broken = this.sends.broken();
    if (!this.broken) this.sink.frame(this.closed - 1, cycles, instructions, this.sends);
    this.closed++;
    this.baseTime += instructions;
    this.baseCycles += cycles;
    this.#lastCycles = cycles;
    this.#lastInstructions = instructions;
    this.sends.clear();
  }

  /** Put frames into the ring. */
  protected fill(first: number, count: number): void {
    const { instance, source } = this;
    source.copy(first, count, instance.bytes, instance.about.frames.ring);
    instance.setLong("taken", first);
    instance.setWord("position", 0);
    instance.setWord("available", count);
  }

  /** Take a snapshot. The block is that of a refill; in the stepping form it may be any. */
  capture(block = this.block): Moment {
    const { instance } = this;
    const isBetween = this.isBetween;
    const isNew = this.closed === 0 && instance.long("instructions") === 0;
    instance.complete(block);
    return {
      time: this.baseTime + instance.long("instructions"),
      baseTime: this.baseTime,
      baseCycles: this.baseCycles,
      frame: this.frame,
      closed: this.closed,
      last: this.last,
      key: keyOf(this.blockAt(block)),
      within: !isBetween,
      sends: this.sends.saved(),
      state: isNew ? null : instance.bytes.slice(0, instance.about.state_end),
    };
  }

  /** Put a snapshot into this instance, which must be new if the snapshot is of a new one. */
  protected put(moment: Moment, block: number): void {
    const { instance } = this;
    const { about } = instance;
    if (moment.state) instance.bytes.set(moment.state);
    instance.emptyLog();
    this.#log = about.log;
    this.#data = about.data;
    instance.setWord("frame", about.frames.first);
    if (moment.state && moment.within && moment.frame >= 0) {
      this.source.copy(moment.frame, 1, instance.bytes, about.frames.first);
    }
    this.sends.restore(moment.sends);
    this.block = block;
    this.baseTime = moment.baseTime;
    this.baseCycles = moment.baseCycles;
    this.closed = moment.closed;
    this.#lastCycles = moment.last.cycles;
    this.#lastInstructions = moment.last.instructions;
    this.broken = null;
    this.ended = null;
    this.halted = false;
  }

  /** Return the view of the chip before the block at which it stands. */
  view(): ChipView {
    const { instance, here, frame } = this;
    const { about, size } = instance;
    instance.complete(this.block);
    const depth = here.depth ?? 0;
    const bits = instance.bits("masks", depth);
    const masks = Array.from({ length: depth }, (_, i) => bits.slice(i * size, (i + 1) * size));
    return {
      address: here.address + (this.halted ? 1 : 0),
      stack: here.stack ?? [],
      depth,
      frame,
      frameCycles: this.frameCycles,
      frameInstructions: this.frameInstructions,
      cycles: this.cycles,
      instructions: this.time,
      ended: this.ended !== null,
      status: this.ended?.status ?? null,
      error: this.ended?.error ?? null,
      registers: instance.planes("registers", 16),
      zero: instance.bits("zero", 1),
      carry: instance.bits("carry", 1),
      active: masks.at(-1)?.slice() ?? new Uint8Array(size).fill(1),
      masks,
      memory: instance.planes("memory", about.memory_bytes),
      exposed: frame < 0 ? null : this.source.get(frame).slice(),
    };
  }
}
