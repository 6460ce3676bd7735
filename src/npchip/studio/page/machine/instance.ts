/** An instance of one form: its memory by name, and its functions. */

import type { Description, Form, LongName, PlaneName, WordName } from "./description";

interface Exports {
  memory: WebAssembly.Memory;
  run(block: number): number;
  complete(block: number): void;
}

const HIGH = 2 ** 32;

/** A module at work. `ask` answers its requests and must be set before `run`. */
export class Instance {
  readonly about: Description;
  readonly bytes: Uint8Array<ArrayBuffer>;
  /** The memory by words of 4 bytes. Machines with browsers are little-endian, as modules are. */
  readonly words: Uint32Array<ArrayBuffer>;
  /** Number of NPs. */
  readonly size: number;
  ask: (request: number, block: number) => number = () => 0;
  readonly #exports: Exports;

  constructor(form: Form) {
    this.about = form.about;
    const imports = { host: { ask: (request: number, block: number) => this.ask(request, block) } };
    const instance = new WebAssembly.Instance(form.module, imports);
    this.#exports = instance.exports as unknown as Exports;
    const buffer = this.#exports.memory.buffer as ArrayBuffer;
    this.bytes = new Uint8Array(buffer);
    this.words = new Uint32Array(buffer);
    this.size = form.about.np_rows * form.about.np_cols;
  }

  run(block: number): number {
    return this.#exports.run(block);
  }

  complete(block: number): void {
    this.#exports.complete(block);
  }

  word(name: WordName): number {
    return this.words[this.about.words[name] >>> 2] as number;
  }

  setWord(name: WordName, value: number): void {
    this.words[this.about.words[name] >>> 2] = value;
  }

  long(name: LongName): number {
    return this.longAt(this.about.longs[name]);
  }

  /** A number of 8 bytes; big integers would be slow. */
  longAt(address: number): number {
    const at = address >>> 2;
    return (this.words[at] as number) + HIGH * (this.words[at + 1] as number);
  }

  setLong(name: LongName, value: number): void {
    const at = this.about.longs[name] >>> 2;
    this.words[at] = value % HIGH;
    this.words[at + 1] = Math.floor(value / HIGH);
  }

  /** Address of a plane. */
  planeAt(name: PlaneName, index = 0): number {
    return this.about.planes[name] + index * this.about.stride;
  }

  /** Copy planes that follow one another, without the gaps between them. */
  planes(name: PlaneName, count: number): Uint8Array<ArrayBuffer> {
    const { size } = this;
    const { stride } = this.about;
    const start = this.planeAt(name);
    if (stride === size) return this.bytes.slice(start, start + count * size);
    const copy = new Uint8Array(count * size);
    for (let i = 0; i < count; i++) {
      const at = start + i * stride;
      copy.set(this.bytes.subarray(at, at + size), i * size);
    }
    return copy;
  }

  /** Copy planes of 0 and 255 as 0 and 1. */
  bits(name: PlaneName, count: number): Uint8Array<ArrayBuffer> {
    const copy = this.planes(name, count);
    for (let i = 0; i < copy.length; i++) if (copy[i]) copy[i] = 1;
    return copy;
  }

  /** Say that the log and the records have been taken. */
  emptyLog(): void {
    this.setWord("closed", 0);
    this.setWord("log_end", this.about.log);
    this.setWord("data_end", this.about.data);
  }
}
