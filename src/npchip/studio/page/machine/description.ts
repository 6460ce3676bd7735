/** A module's description of itself: the JSON of docs/module.md. */

import type { OutputKind } from "../protocol";

export interface Exit {
  status: "halted" | "failed";
  cycles?: number;
  code?: string;
  message?: string;
}

/** A place at which the module can stop. */
export interface Block {
  address: number;
  stack?: number[];
  depth?: number;
  exposes?: true;
  port?: number;
  exit?: Exit;
}

export interface Site {
  address: number;
  port: number;
  planes: number;
}

export type WordName =
  | "position"
  | "available"
  | "log_end"
  | "data_end"
  | "conversions"
  | "frame"
  | "closed";
export type LongName = "cycles" | "instructions" | "check" | "first_check" | "taken";
export type PlaneName = "registers" | "zero" | "carry" | "masks" | "memory" | "received";

export interface Description {
  version: number;
  program: string;
  machine: string;
  form: "run" | "step";
  np_rows: number;
  np_cols: number;
  memory_bytes: number;
  mask_depth: number;
  outputs: { name: string; port: number; kind: OutputKind }[];
  requests: Record<"refill" | "tick" | "drain" | "receive", number>;
  words: Record<WordName, number>;
  longs: Record<LongName, number>;
  state_end: number;
  stride: number;
  planes: Record<PlaneName, number>;
  frames: { bytes: number; ring: number; capacity: number; first: number };
  records: number;
  log: number;
  data: number;
  pictures: number | null;
  sites: Site[];
  blocks: Block[];
}

/** One of the two forms of a program: its code, and what it says about itself. */
export interface Form {
  module: WebAssembly.Module;
  about: Description;
}

const VERSION = 1;

/**
 * Both forms of a program. The stepping form is compiled when it is first asked for; it may come
 * later than the run form, as it takes the assembler longer.
 */
export class Forms {
  readonly run: Form;
  #step: Form | null = null;
  #section: ArrayBuffer | undefined;
  #missing: string | null = null;
  readonly #arrival: Promise<void>;
  #arrived: () => void = () => undefined;

  constructor(bytes: Uint8Array<ArrayBuffer>) {
    const module = new WebAssembly.Module(bytes);
    this.run = described(module);
    this.#section = steppingOf(module);
    this.#arrival = new Promise((resolve) => {
      this.#arrived = resolve;
    });
  }

  /** Take the whole module of the program; null if it is not to be had, and why. */
  complete(whole: Uint8Array<ArrayBuffer> | null, why: string): void {
    this.#section ??= whole ? steppingOf(new WebAssembly.Module(whole)) : undefined;
    this.#missing = why;
    this.#arrived();
  }

  /** Wait for the stepping form, some milliseconds at most; false if it is not there then. */
  async arrives(milliseconds: number): Promise<boolean> {
    if (!this.#section && this.#missing === null) {
      let timer: ReturnType<typeof setTimeout> | undefined;
      const late = new Promise<void>((resolve) => {
        timer = setTimeout(resolve, milliseconds);
      });
      await Promise.race([this.#arrival, late]);
      clearTimeout(timer);
    }
    return this.#section !== undefined || this.#missing !== null;
  }

  get step(): Form {
    if (!this.#step) {
      if (!this.#section) {
        throw new Error(this.#missing || "the program has no stepping form: assemble it again");
      }
      this.#step = described(new WebAssembly.Module(this.#section));
    }
    return this.#step;
  }
}

function steppingOf(module: WebAssembly.Module): ArrayBuffer | undefined {
  return WebAssembly.Module.customSections(module, "npchip.step")[0];
}

function described(module: WebAssembly.Module): Form {
  const [section] = WebAssembly.Module.customSections(module, "npchip");
  if (!section) throw new Error("this is no program of npchip: its section 'npchip' is missing");
  const about = JSON.parse(new TextDecoder().decode(section)) as Description;
  if (about.version !== VERSION) {
    throw new Error(`the program has version ${about.version}; this page reads ${VERSION} only`);
  }
  return { module, about };
}

/** Return the key of a block: its address, its open calls, its open masked regions. */
export function keyOf(block: Block): string {
  return JSON.stringify([block.address, block.stack ?? [], block.depth ?? 0]);
}

/** Blocks by their key; -1 where several have the same, as may be in the form `run`. */
export function blocksByKey(about: Description): Map<string, number> {
  const found = new Map<string, number>();
  about.blocks.forEach((block, index) => {
    const key = keyOf(block);
    found.set(key, found.has(key) ? -1 : index);
  });
  return found;
}
