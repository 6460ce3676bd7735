/** Reads the values that conditions name, before a block of the stepping form. */

import type { Cell, Quantity } from "../protocol";
import type { Stepper } from "./stepper";

const SIDE = 8;

export class Reader {
  #block = 0;
  #isComplete = false;

  constructor(private readonly chip: Stepper) {}

  /** Look at the chip as it stands before a block, at a `tick`. */
  at(block: number): void {
    this.#block = block;
    this.#isComplete = false;
  }

  /** Read a quantity that is one number. */
  number(quantity: Exclude<Quantity, { kind: "cell" }>): number {
    switch (quantity.kind) {
      case "one":
        return this.one(quantity.cell, this.np(quantity.row, quantity.column));
      case "pixel":
        return this.#pixel(quantity.row, quantity.column);
      case "counter":
        return this.#counter(quantity.name);
    }
  }

  /** Copy the values of a cell in all NPs; flags and activity are 0 or 1. */
  plane(cell: Cell): Uint8Array {
    const { size } = this.chip.instance;
    return Uint8Array.from({ length: size }, (_, np) => this.one(cell, np));
  }

  /** Index of an NP. */
  np(row: number, column: number): number {
    return row * this.chip.instance.about.np_cols + column;
  }

  get memoryBytes(): number {
    return this.chip.instance.about.memory_bytes;
  }

  /** Read a cell of an NP. */
  one(cell: Cell, np: number): number {
    const { instance } = this.chip;
    if (!this.#isComplete) {
      instance.complete(this.#block);
      this.#isComplete = true;
    }
    const index = Number(cell.index);
    const bit = (plane: number) => (instance.bytes[plane + np] ? 1 : 0);
    switch (cell.kind) {
      case "register":
        return instance.bytes[instance.planeAt("registers", index) + np] ?? 0;
      case "memory":
        return instance.bytes[instance.planeAt("memory", index) + np] ?? 0;
      case "flag":
        return bit(instance.planeAt(cell.index === "Z" ? "zero" : "carry"));
      case "active": {
        const depth = this.#here.depth ?? 0;
        return depth ? bit(instance.planeAt("masks", depth - 1)) : 1;
      }
    }
  }

  get #here() {
    const { blocks } = this.chip.instance.about;
    return blocks[this.#block] as (typeof blocks)[number];
  }

  #pixel(row: number, column: number): number {
    const { instance, frame } = this.chip;
    if (frame < 0) return 0;
    const at = instance.word("frame") + row * instance.about.np_cols * SIDE + column;
    return instance.bytes[at] ?? 0;
  }

  #counter(name: string): number {
    const { chip } = this;
    switch (name) {
      case "pc":
        return this.#here.address;
      case "frame":
        return chip.frame;
      case "cycles":
        return chip.cycles;
      case "frame_cycles":
        return chip.frameCycles;
      case "instructions":
        return chip.time;
      case "calls":
        return this.#here.stack?.length ?? 0;
      default:
        throw new Error(`no counter is called ${name}`);
    }
  }
}
