/** Breakpoints and conditions at work: the meaning is that of `npchip debug`. */

import type { Breakpoint, ConditionTree, Op, Quantity, Test } from "../protocol";
import { Reader } from "./reading";
import type { Stepper } from "./stepper";

const COMPARE: Record<Op, (a: number, b: number) => boolean> = {
  "==": (a, b) => a === b,
  "!=": (a, b) => a !== b,
  "<": (a, b) => a < b,
  "<=": (a, b) => a <= b,
  ">": (a, b) => a > b,
  ">=": (a, b) => a >= b,
};

/** A breakpoint that was met; `condition` is null for a plain one. */
export interface Hit {
  condition: ConditionTree | null;
}

/** Watches for one breakpoint. */
class Monitor {
  readonly condition: ConditionTree | null;
  /** Addresses at which it stops, before they are executed; null for an event or a test alone. */
  readonly places: number[] | null;
  /** Instructions after which it is asked; null for all. */
  readonly triggers: number[] | null;
  /** Those of them after which it stops; null for all. */
  readonly #causes: number[] | null;
  #before: number | Uint8Array | boolean = false;

  constructor({ addresses, condition }: Breakpoint) {
    this.condition = condition;
    const own = condition?.places?.length ? condition.places : null;
    const isEvent = condition !== null && condition.event !== null;
    this.places = isEvent ? null : (own ?? (addresses.length || !condition ? addresses : null));
    this.triggers = this.places ? [] : (condition?.triggers ?? null);
    // An event on a line is one that an instruction of this line causes.
    this.#causes = this.places || !addresses.length ? null : addresses;
  }

  begin(reader: Reader): void {
    if (this.places) return;
    const event = this.condition?.event;
    if (event?.kind === "changes") this.#before = reading(event.value, reader);
    else if (this.condition?.test) this.#before = holds(this.condition.test, reader);
  }

  /** Return whether the instruction at an address, a trigger, has just caused the event. */
  happens(address: number, reader: Reader, chip: Stepper): boolean {
    const isSo = this.#happens(reader, chip);
    return isSo && (this.#causes?.includes(address) ?? true);
  }

  #happens(reader: Reader, chip: Stepper): boolean {
    const event = this.condition?.event;
    if (event?.kind === "sent") return sent(event.op, event.number ?? 0, chip);
    const before = this.#before;
    this.begin(reader);
    if (event) return !isEqual(before, this.#before);
    return this.#before === true && before === false;
  }

  /** Return whether it stops at one of its places. */
  stops(reader: Reader): boolean {
    const test = this.condition?.test;
    return !test || holds(test, reader);
  }
}

function reading(value: Quantity, reader: Reader): number | Uint8Array {
  return value.kind === "cell" ? reader.plane(value.cell) : reader.number(value);
}

function isEqual(a: number | Uint8Array | boolean, b: number | Uint8Array | boolean): boolean {
  if (!(a instanceof Uint8Array) || !(b instanceof Uint8Array)) return a === b;
  return a.every((byte, np) => byte === b[np]);
}

function holds(test: Test, reader: Reader): boolean {
  if (test.kind === "mask-empty") {
    return !reader.plane({ kind: "active", index: "" }).includes(1);
  }
  const compare = (value: number) => COMPARE[test.op](value, test.number);
  if (test.value.kind !== "cell") return compare(reader.number(test.value));
  const plane = reader.plane(test.value.cell);
  return test.quantifier === "any" ? plane.some(compare) : plane.every(compare);
}

/** Return whether the last send has such a byte from an active NP. */
function sent(op: Op | null, number: number, chip: Stepper): boolean {
  if (op === null) return true;
  const { instance } = chip;
  const { about, words, bytes, size } = instance;
  const word = words[(instance.word("log_end") - 4) >>> 2] as number;
  const planes = about.sites[word >>> 8]?.planes ?? 0;
  const compare = COMPARE[op];
  if (!planes) return compare(word & 255, number);
  const data = instance.word("data_end") - planes * about.stride;
  for (let np = 0; np < size; np++) {
    const isActive = planes < 2 || bytes[data + about.stride + np];
    if (isActive && compare(bytes[data + np] ?? 0, number)) return true;
  }
  return false;
}

const PLACE = 1;
const TRIGGER = 2;

/** Watches for several breakpoints along one run. */
export class Watch {
  readonly reader: Reader;
  readonly #monitors: Monitor[];
  /** Bits of the checks to make, by address. */
  readonly #marks: Uint8Array;

  constructor(
    private readonly chip: Stepper,
    breakpoints: Breakpoint[],
  ) {
    this.reader = new Reader(chip);
    this.#monitors = breakpoints.map((breakpoint) => new Monitor(breakpoint));
    const { blocks } = chip.instance.about;
    this.#marks = new Uint8Array(2 + blocks.reduce((most, b) => Math.max(most, b.address), 0));
    for (const { places, triggers } of this.#monitors) {
      for (const address of places ?? []) this.#mark(address, PLACE);
      if (triggers) for (const address of triggers) this.#mark(address, TRIGGER);
      else this.#marks.forEach((_, address) => this.#mark(address, TRIGGER));
    }
  }

  #mark(address: number, mark: number): void {
    this.#marks[address] = (this.#marks[address] ?? 0) | mark;
  }

  get isEmpty(): boolean {
    return this.#monitors.length === 0;
  }

  /** Take the present state as given, so that only later changes count. */
  begin(block: number): void {
    this.reader.at(block);
    for (const monitor of this.#monitors) monitor.begin(this.reader);
  }

  /** Return the hit after the instruction at an address, before a block; null if there is none. */
  after(address: number, block: number): Hit | null {
    const here = this.chip.instance.about.blocks[block]?.address ?? 0;
    const isTrigger = (this.#marks[address] ?? 0) & TRIGGER;
    if (!isTrigger && !((this.#marks[here] ?? 0) & PLACE)) return null;
    this.reader.at(block);
    let hit: Hit | null = null;
    for (const monitor of this.#monitors) {
      const { places, triggers } = monitor;
      if (places) {
        if (places.includes(here) && monitor.stops(this.reader)) hit ??= monitor;
      } else if (!triggers || triggers.includes(address)) {
        if (monitor.happens(address, this.reader, this.chip)) hit ??= monitor;
      }
    }
    return hit;
  }
}
