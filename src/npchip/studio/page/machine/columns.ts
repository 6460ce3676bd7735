/** Complete frames in columns that grow: what the chip collects between two messages. */

import type { FrameBatch, FrameDocument, OutputColumn, Value } from "../protocol";
import { type Alike, RECORD } from "./alike";
import type { Description } from "./description";
import { type PortSends, Sends } from "./sends";

/**
 * A column as it travels: all in one array each, since a thousand small arrays are slow to send.
 * `counts` is -1 for nothing sent; else for a list its length, for planes and pictures 1.
 */
export type PackedColumn =
  | { kind: "scalar" | "scalar16"; values: Float64Array<ArrayBuffer> }
  | {
      kind: "list" | "plane" | "picture";
      rows: number;
      cols: number;
      counts: Int32Array<ArrayBuffer>;
      data: Uint8Array<ArrayBuffer>;
    };

/** A `FrameBatch` as it travels. */
export interface PackedBatch {
  first: number;
  cycles: Float64Array<ArrayBuffer>;
  instructions: Float64Array<ArrayBuffer>;
  outputs: Record<string, PackedColumn>;
  frames: Uint8Array<ArrayBuffer> | null;
  setup?: FrameDocument;
}

type Numbers = Float64Array<ArrayBuffer> | Int32Array<ArrayBuffer> | Uint8Array<ArrayBuffer>;

/** Numbers with room to grow. It has one type of array, as code for several is slow. */
class Floats {
  length = 0;
  #array = new Float64Array(64);

  push(value: number): void {
    const at = this.length;
    if (at < this.#array.length) {
      this.length++;
      this.#array[at] = value;
    } else this.extend(1)[at] = value;
  }

  /** Make room for more, and return the array. */
  extend(count: number): Float64Array {
    const start = this.length;
    this.length += count;
    if (this.length > this.#array.length) {
      const larger = new Float64Array(Math.max(this.length, 2 * this.#array.length));
      larger.set(this.#array.subarray(0, start));
      this.#array = larger;
    }
    return this.#array;
  }

  /** Take the content out. */
  take(): Float64Array<ArrayBuffer> {
    const content = this.#array.slice(0, this.length);
    this.length = 0;
    return content;
  }
}

/** Bytes with room to grow. */
class Octets {
  length = 0;
  array = new Uint8Array(0);

  /** Make room for more, and return where it begins. */
  extend(count: number): number {
    const start = this.length;
    this.length += count;
    if (this.length > this.array.length) {
      const larger = new Uint8Array(Math.max(64, 2 * this.length));
      larger.set(this.array.subarray(0, start));
      this.array = larger;
    }
    return start;
  }

  /** Take the content out. */
  take(): Uint8Array<ArrayBuffer> {
    const content = this.array.slice(0, this.length);
    this.length = 0;
    return content;
  }
}

class Column {
  private readonly values = new Floats();
  private readonly counts = new Floats();
  readonly data = new Octets();
  private readonly isNumber: boolean;
  private readonly rows: number;
  private readonly cols: number;

  /** A column for values such as a port has. */
  constructor(private readonly like: PortSends) {
    const port = like;
    this.isNumber = port.kind === "scalar" || port.kind === "scalar16";
    const side = port.kind === "picture" ? 8 : 1;
    this.rows = side * port.rows;
    this.cols = side * port.cols;
  }

  /** Add what a port has in this frame; null for nothing. */
  add(port: PortSends | null): void {
    if (this.isNumber) {
      this.values.push(port ? port.number() : NaN);
      return;
    }
    if (!port) {
      this.counts.push(-1);
      return;
    }
    const { list } = port;
    const length = port.kind === "list" ? list.length : 1;
    this.counts.push(length);
    if (port.kind === "list") {
      const at = this.data.extend(length);
      this.data.array.set(list, at);
    } else {
      const at = this.data.extend(this.rows * this.cols);
      port.draw(this.data.array, at);
    }
  }

  /** Add numbers that several frames sent, all at the same place of their sends. */
  addAlike({ instance, start, each, count }: Alike, skip: number, place: number): void {
    const { words } = instance;
    const first = this.values.length - skip;
    const values = this.values.extend(count - skip);
    for (let i = skip; i < count; i++) {
      values[first + i] = (words[start + i * each + place] as number) & 255;
    }
  }

  take(): PackedColumn {
    const { kind } = this.like;
    if (kind === "scalar" || kind === "scalar16") return { kind, values: this.values.take() };
    const { rows, cols } = this;
    return { kind, rows, cols, counts: new Int32Array(this.counts.take()), data: this.data.take() };
  }
}

/** Collects complete frames. Ports without an `.output` come once something was sent to them. */
export class Columns {
  private readonly cycles = new Floats();
  private readonly instructions = new Floats();
  private readonly inputs = new Octets();
  /** By their place in `Sends.ports`. */
  private readonly columns: (Column | undefined)[];
  private readonly ports: PortSends[];
  private first = 0;
  /** True if there is a column of a port without an `.output`. */
  private hasOthers = false;

  constructor(about: Description) {
    this.ports = new Sends(about).ports;
    this.columns = this.ports.map((port) => (port.declared ? new Column(port) : undefined));
  }

  get count(): number {
    return this.cycles.length;
  }

  /** Bytes that wait to be taken. */
  get size(): number {
    let size = 16 * this.count + this.inputs.length;
    for (const column of this.columns) if (column) size += column.data.length + 8 * this.count;
    return size;
  }

  /** Add a frame; without values if it broke off and its sends are not readable. */
  add(
    sends: Sends,
    cycles: number,
    instructions: number,
    input: Uint8Array | null = null,
    isReadable = true,
  ): void {
    const { columns } = this;
    const isMore = this.hasOthers || sends.hasOthers;
    const count = isMore ? columns.length : sends.outputs;
    for (let i = 0; i < count; i++) {
      const port = sends.ports[i] as PortSends;
      const value = isReadable && port.count ? port : null;
      const column = columns[i] ?? (value && !port.declared ? this.#begin(i, port) : undefined);
      column?.add(value);
    }
    this.cycles.push(cycles);
    this.instructions.push(instructions);
    if (input) {
      const at = this.inputs.extend(input.length); // may replace the array
      this.inputs.array.set(input, at);
    }
  }

  /** Add frames that sent numbers in the same way, without the first `skip`. */
  addAlike(alike: Alike, skip: number): void {
    const { instance, record, count, places } = alike;
    for (let i = 0; i < this.columns.length && skip < count; i++) {
      const place = places[i] ?? -1;
      if (place >= 0) this.columns[i]?.addAlike(alike, skip, place);
      else for (let frame = skip; frame < count; frame++) this.columns[i]?.add(null);
    }
    for (let i = skip, at = record + skip * RECORD; i < count; i++, at += RECORD) {
      this.cycles.push(instance.longAt(at));
      this.instructions.push(instance.longAt(at + 8));
    }
  }

  #begin(place: number, port: PortSends): Column {
    const column = new Column(port);
    for (let i = 0; i < this.count; i++) column.add(null);
    this.columns[place] = column;
    this.hasOthers = true;
    return column;
  }

  /** Take all frames out. */
  take(): PackedBatch {
    const first = this.first;
    this.first += this.count;
    const outputs: Record<string, PackedColumn> = {};
    this.ports.forEach((port, i) => {
      const column = this.columns[i];
      if (!column) return;
      outputs[port.name] = column.take();
      if (!port.declared) this.columns[i] = undefined;
    });
    this.hasOthers = false;
    return {
      first,
      cycles: this.cycles.take(),
      instructions: this.instructions.take(),
      outputs,
      frames: this.inputs.length ? this.inputs.take() : null,
    };
  }
}

/** A column as the page reads it; its arrays share one buffer. */
function unpackedColumn(column: PackedColumn): OutputColumn {
  if ("values" in column) return column;
  const { kind, rows, cols, counts, data } = column;
  let at = 0;
  const next = (length: number) => data.subarray(at, (at += length));
  if (kind === "list") {
    const values = Array.from(counts, (count) => (count < 0 ? null : [...next(count)]));
    return { kind, values };
  }
  const size = rows * cols;
  return { kind, rows, cols, values: Array.from(counts, (n) => (n < 0 ? null : next(size))) };
}

/** Return a batch as the protocol has it. */
export function unpacked(batch: PackedBatch): FrameBatch {
  const outputs = Object.entries(batch.outputs).map(
    ([name, column]) => [name, unpackedColumn(column)] as const,
  );
  return { ...batch, outputs: Object.fromEntries(outputs) };
}

/** Buffers of a batch, to be handed over instead of copied. */
export function buffersOf(batch: PackedBatch): ArrayBuffer[] {
  const arrays: Numbers[] = [batch.cycles, batch.instructions];
  if (batch.frames) arrays.push(batch.frames);
  for (const column of Object.values(batch.outputs)) {
    if ("values" in column) arrays.push(column.values);
    else arrays.push(column.counts, column.data);
  }
  return arrays.map((array) => array.buffer);
}

/** Return frames in plain form, as in the JSON of a run. */
export function documents(packed: PackedBatch): FrameDocument[] {
  const batch = unpacked(packed);
  const columns = Object.entries(batch.outputs);
  return Array.from(batch.cycles, (cycles, index) => ({
    cycles,
    instructions: batch.instructions[index] ?? 0,
    outputs: Object.fromEntries(columns.map(([name, column]) => [name, plain(column, index)])),
  }));
}

function plain(column: OutputColumn, index: number): Value {
  const value = column.values[index] ?? null;
  if (value === null || Number.isNaN(value)) return null;
  if (!("rows" in column)) return value as number | number[];
  const { cols, rows } = column;
  const pixels = value as Uint8Array;
  return Array.from({ length: rows }, (_, row) => [
    ...pixels.subarray(row * cols, (row + 1) * cols),
  ]);
}
