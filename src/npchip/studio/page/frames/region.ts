/** A large file, read a window at a time. */

import { damaged } from "./errors";

const WINDOW = 1 << 20;

/** Bytes anywhere in a file; those asked for in order are read from the disk in large parts. */
export class Region {
  private held = new Uint8Array(0);
  private start = 0;
  /** Share of the file that was read, 0 to 1. */
  share = 0;

  constructor(private readonly file: File) {}

  get size(): number {
    return this.file.size;
  }

  get name(): string {
    return this.file.name;
  }

  /** Read bytes; throws if the file ends before. */
  async read(at: number, length: number): Promise<Uint8Array<ArrayBuffer>> {
    if (at + length > this.size) throw this.cut(at + length);
    if (at < this.start || at + length > this.start + this.held.length) {
      const end = Math.min(this.size, at + Math.max(WINDOW, length));
      this.held = new Uint8Array(await this.file.slice(at, end).arrayBuffer());
      this.start = at;
    }
    this.share = Math.max(this.share, (at + length) / this.size);
    return this.held.slice(at - this.start, at - this.start + length);
  }

  /** Return the error for a file that should reach further. */
  cut(end: number): Error {
    return damaged(this.name, `the file is cut short: ${end - this.size} bytes are missing`);
  }
}
