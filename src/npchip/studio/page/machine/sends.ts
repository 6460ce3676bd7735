/** Sends of the present frame, as far as its outputs depend on them. */

import type { OutputKind } from "../protocol";
import type { Description, Site } from "./description";
import type { Instance } from "./instance";

/** A rule of docs/module.md, "Outputs", that a frame broke. */
export interface Broken {
  code: "NP310" | "NP311";
  message: string;
  address: number;
}

const PICTURE = 64;
const SIDE = 8;
const PORTS = 16;
/** Bytes of a list for which room is kept from frame to frame. */
const ROOM = 4096;

/** Sends of a frame to one port, folded as they come, so that an endless frame takes little. */
export class PortSends {
  /** Sends that count. */
  count = 0;
  /** True if there was a send since `clear`, whether it counts or not. */
  isSent = false;
  /** Their bytes: the last one, the first two, or all, as the kind needs. */
  value = 0;
  high = 0;
  #list = new Uint8Array(0);
  /** The last plane, or all 64. */
  readonly planes: Uint8Array<ArrayBuffer>;
  #broken: Broken | null = null;
  #lastAddress = 0;

  constructor(
    readonly name: string,
    readonly port: number,
    readonly kind: OutputKind,
    /** False for a port without an `.output`. */
    readonly declared: boolean,
    readonly rows: number,
    readonly cols: number,
  ) {
    const planes = kind === "picture" ? PICTURE : kind === "plane" ? 1 : 0;
    this.planes = new Uint8Array(planes * rows * cols);
  }

  clear(): void {
    this.count = 0;
    this.isSent = false;
    this.#broken = null;
    if (this.#list.length > ROOM) this.#list = new Uint8Array(0);
  }

  /** Take a byte that all NPs sent to a scalar: `take` for what is sent most, in a fifth of its time. */
  set(byte: number): void {
    this.value = byte;
    this.count++;
    if (this.#broken) this.#broken = null;
  }

  /** Take a send: its byte if the site has no planes, else planes at `data`. */
  take(site: Site, byte: number, bytes: Uint8Array, data: number, stride: number): void {
    const { kind, planes: own } = this;
    const size = this.rows * this.cols;
    if (kind === "plane" || kind === "picture") {
      const index = kind === "plane" ? 0 : this.count;
      if (index < PICTURE) {
        if (site.planes) own.set(bytes.subarray(data, data + size), index * size);
        else own.fill(byte, index * size, (index + 1) * size);
      }
    } else if (!site.planes) {
      if (kind === "scalar") this.#broken = null; // only the last send counts
      this.#number(byte);
    } else {
      const mask = site.planes === 2 ? data + stride : -1;
      let first = 0;
      while (mask >= 0 && first < size && !bytes[mask + first]) first++;
      if (first === size) return; // no NP was active
      byte = bytes[data + first] ?? 0;
      if (kind === "scalar") this.#broken = null;
      for (let np = first + 1; np < size; np++) {
        if (bytes[data + np] !== byte && (mask < 0 || bytes[mask + np])) {
          this.#disagree(site.address, first, byte, np, bytes[data + np] ?? 0);
          break;
        }
      }
      this.#number(byte);
    }
    this.count++;
    this.#lastAddress = site.address;
  }

  #number(byte: number): void {
    if (this.kind === "list") this.#append(byte);
    else if (this.kind === "scalar") this.value = byte;
    else if (this.count === 0) this.value = byte;
    else this.high = byte;
  }

  #append(byte: number): void {
    if (this.count === this.#list.length) {
      const larger = new Uint8Array(Math.max(64, 2 * this.count));
      larger.set(this.#list);
      this.#list = larger;
    }
    this.#list[this.count] = byte;
  }

  /** All bytes of a list. */
  get list(): Uint8Array<ArrayBuffer> {
    return this.#list.subarray(0, this.kind === "list" ? this.count : 0);
  }

  #disagree(address: number, first: number, a: number, other: number, b: number): void {
    const np = (index: number) => `NP(${Math.floor(index / this.cols)},${index % this.cols})`;
    this.#broken ??= {
      code: "NP310",
      message:
        `output '${this.name}' is a ${this.kind}, but ${np(first)} sent ${a} ` +
        `and ${np(other)} sent ${b}`,
      address,
    };
  }

  /** The rule that these sends break, if the frame ends here. */
  broken(): Broken | null {
    const wanted = this.kind === "picture" ? PICTURE : this.kind === "scalar16" ? 2 : 0;
    if (wanted && this.count && this.count !== wanted) {
      const rule =
        this.kind === "picture"
          ? `exactly ${PICTURE} sends, one for each pixel of an NP`
          : "two sends, low byte first";
      return {
        code: "NP311",
        message: `output '${this.name}': a ${this.kind} is ${rule}; found ${this.count}`,
        address: this.#lastAddress,
      };
    }
    return this.#broken;
  }

  /** The number that was sent; only scalars have one. */
  number(): number {
    return this.kind === "scalar16" ? this.value + 256 * this.high : this.value;
  }

  /** Write the plane or picture, row by row. */
  draw(target: Uint8Array, at: number): void {
    const { rows, cols, planes } = this;
    if (this.kind === "plane") {
      target.set(planes, at);
      return;
    }
    let from = 0;
    for (let pixel = 0; pixel < PICTURE; pixel++) {
      const corner = at + (pixel >> 3) * cols * SIDE + (pixel & 7);
      for (let row = 0; row < rows; row++) {
        let to = corner + row * SIDE * cols * SIDE;
        for (let col = 0; col < cols; col++, to += SIDE) target[to] = planes[from++] ?? 0;
      }
    }
  }

  /** A copy to go back to. */
  saved(): PortSends {
    const copy = new PortSends(
      this.name,
      this.port,
      this.kind,
      this.declared,
      this.rows,
      this.cols,
    );
    copy.restore(this);
    return copy;
  }

  restore(from: PortSends): void {
    this.count = from.count;
    this.value = from.value;
    this.high = from.high;
    this.#list = from.list.slice();
    this.planes.set(from.planes);
    this.#broken = from.#broken;
    this.#lastAddress = from.#lastAddress;
  }
}

/** All sends of the present frame, by port. */
export class Sends {
  /** The outputs in their order, then the ports without one. */
  readonly ports: PortSends[];
  /** Number of outputs. */
  readonly outputs: number;
  /** The ports that were sent to, so that a frame costs no look at the others. */
  readonly #sent: PortSends[] = [];
  readonly #byPort: PortSends[] = [];
  readonly #bySite: PortSends[];
  readonly #sites: Site[];

  constructor(about: Description) {
    const { np_rows: rows, np_cols: cols, outputs } = about;
    this.outputs = outputs.length;
    const names = new Set(outputs.map(({ name }) => name));
    const free = Array.from({ length: PORTS }, (_, port) => port).filter(
      (port) => !outputs.some((output) => output.port === port),
    );
    this.ports = [
      ...outputs.map(({ name, port, kind }) => new PortSends(name, port, kind, true, rows, cols)),
      ...free.map((port) => {
        let name = `port${port}`;
        while (names.has(name)) name += "_";
        return new PortSends(name, port, "plane", false, rows, cols);
      }),
    ];
    for (const port of this.ports) this.#byPort[port.port] = port;
    this.#sites = about.sites;
    this.#bySite = about.sites.map(({ port }) => this.#byPort[port] as PortSends);
  }

  /** True if nothing was sent. */
  get empty(): boolean {
    return this.#sent.length === 0;
  }

  /** True if something was sent to a port without an `.output`. */
  get hasOthers(): boolean {
    return this.#sent.some(({ declared }) => !declared);
  }

  clear(): void {
    for (const port of this.#sent) port.clear();
    this.#sent.length = 0;
  }

  /** Take sends of the log from one address up to another; return where their planes end. */
  take(instance: Instance, from: number, to: number, data: number): number {
    const { words, bytes } = instance;
    const { stride } = instance.about;
    for (let at = from >>> 2; at < to >>> 2; at++) {
      const word = words[at] as number;
      const site = this.#sites[word >>> 8] as Site;
      const port = this.#bySite[word >>> 8] as PortSends;
      if (!port.isSent) this.#send(port);
      if (!site.planes && port.kind === "scalar") port.set(word & 255);
      else port.take(site, word & 255, bytes, data, stride);
      data += site.planes * stride;
    }
    return data;
  }

  #send(port: PortSends): void {
    port.isSent = true;
    this.#sent.push(port);
  }

  /** The first rule that the frame breaks. */
  broken(): Broken | null {
    for (let i = 0; i < this.outputs && !this.empty; i++) {
      const broken = (this.ports[i] as PortSends).broken();
      if (broken) return broken;
    }
    return null;
  }

  /** A copy to go back to; null if nothing was sent. */
  saved(): PortSends[] | null {
    return this.empty ? null : this.ports.filter(({ count }) => count).map((port) => port.saved());
  }

  restore(from: PortSends[] | null): void {
    this.clear();
    for (const saved of from ?? []) {
      const port = this.#byPort[saved.port] as PortSends;
      this.#send(port);
      port.restore(saved);
    }
  }
}
