/** Messages between the page, its compiler and its chip. */

import type { ConditionTree, Quantity } from "./conditions";

export type { Cell, ConditionTree, Op, Quantity, Test } from "./conditions";

// ---- the compiler: npchip's Python in Pyodide, in a worker of its own

/** A program as the editor holds it: its files by name, the first to assemble is `main`. */
export interface Project {
  main: string;
  files: Record<string, string>;
}

/** A machine by name, or the text of a machine file. */
export interface MachineChoice {
  name: string;
  text?: string;
}

/** Bytes that lie in the NPs' memories before a run, plane after plane, row by row. */
export interface MemoryPart {
  address: number;
  planes: number;
  data: Uint8Array;
}

export interface CompileRequest {
  project: Project;
  machine: MachineChoice;
  defines: Record<string, number>;
  memory: MemoryPart[];
  /**
   * False to find mistakes only, which is faster; `run` for a module that cannot step yet, which
   * takes half the time of a whole one: see `Compiler.whole`.
   */
  module: boolean | "run";
}

/** A place in a source; lines and columns count from 1. */
export interface Place {
  file: string;
  line: number;
  column: number;
  length: number;
}

export interface Diagnostic {
  severity: "error" | "warning";
  code: string;
  message: string;
  /** The remedy. */
  help: string | null;
  place: Place | null;
  notes: { message: string; place: Place }[];
}

/** A word of the program memory. */
export interface Word {
  /** Source lines that made it: the line of the instruction first, then the uses of macros. */
  origins: { file: string; line: number }[];
  /** The instruction, disassembled. */
  text: string;
  /** Cycles of one execution on the chosen machine. */
  cycles: number;
  /** Values that it takes from neighbours; left out if it takes none. */
  moves?: Move[];
}

/** A value that each active NP takes from a neighbour. */
export interface Move {
  /** Place of the neighbour, relative to the NP that reads: north is row -1. */
  row: number;
  column: number;
  /** Register of the neighbour that held the value before; null if it was worked out first. */
  register: number | null;
}

export type OutputKind = "scalar" | "scalar16" | "list" | "plane" | "picture";

export interface Output {
  name: string;
  port: number;
  kind: OutputKind;
}

export interface Definition {
  name: string;
  kind: "label" | "constant" | "register" | "macro" | "output";
  place: Place;
  /** One line for a hover card, such as its value. */
  text: string;
}

export interface MachineInfo {
  name: string;
  summary: string;
  np_rows: number;
  np_cols: number;
  memory_bytes: number;
  mask_depth: number;
  rom_words: number;
}

export interface ProgramInfo {
  name: string;
  words: Word[];
  labels: Record<string, number>;
  symbols: Record<string, number>;
  /** Numbers of named registers. */
  registers: Record<string, number>;
  outputs: Output[];
  definitions: Definition[];
  machine: MachineInfo;
  /** True if some instruction takes a frame. */
  exposes: boolean;
  budgets: { words: number | null; cycles: number | null };
  /** Of precompiled programs; else null, and `Compiler.bounds` finds them. */
  bounds: Bounds | null;
}

/** Bounds of a frame's cycles that are known without a run; `most` is null if there is none. */
export interface Bounds {
  least: number;
  most: number | null;
}

export interface Compiled {
  diagnostics: Diagnostic[];
  /** Null if there are errors. */
  program: ProgramInfo | null;
  /** As docs/module.md specifies; null if there are errors, or if it was not asked for. */
  module: Uint8Array<ArrayBuffer> | null;
  milliseconds: { assemble: number; translate: number };
}

/** An instruction, directive or other word of the language. */
export interface Entry {
  name: string;
  kind: "instruction" | "directive" | "condition" | "register" | "word";
  /** One line. */
  summary: string;
  /** Syntax of each form, such as `ADD d, a, b`. */
  syntax: string[];
  /** The manual page, as plain text. */
  page: string;
}

/** A rule of colours: at a position in a line the first rule that matches counts. */
export interface ColourRule {
  kind: string;
  pattern: string;
}

/** The language, as the editor knows it before it sees a program. */
export interface Language {
  entries: Entry[];
  colours: ColourRule[];
  machines: { name: string; summary: string }[];
}

/** A frame's outputs in plain form: planes and pictures as nested lists, nothing sent as null. */
export type Value = number | number[] | number[][] | null;

/** A run as `npchip run --json` prints it, with planes and pictures in place. */
export interface RunDocument {
  status: "halted" | "frames-exhausted" | "cycle-limit" | "failed";
  error?: { code: string; message: string; address: number };
  instructions: number;
  cycles: number;
  setup: FrameDocument;
  frames: FrameDocument[];
  /** The place of a run that reached the cycle limit: its verdict names the loop. */
  stoppedAt?: { address: number; stack: number[]; depth: number };
}

export interface FrameDocument {
  cycles: number;
  instructions: number;
  outputs: Record<string, Value>;
  /** Present if the run broke off in this frame, the last. */
  complete?: false;
}

/** A `; run:` line with what a host must do for it. */
export interface TestRun {
  name: string;
  place: Place;
  /** Name of a clip, relative to the source; null without. */
  frames: string | null;
  levels: number[] | null;
  first: number | null;
  fit: "crop" | "resize" | null;
  machine: string;
  defines: Record<string, number>;
  memory: MemoryPart[];
  maxCycles: number;
  /** The reason that the page cannot run it, such as a partner; null if it can. */
  refused: string | null;
}

export interface Verdict {
  run: string;
  machine: string;
  claim: string;
  place: Place;
  /** Null for a run that could not be made: `found` says why. */
  holds: boolean | null;
  /** The values found, as `npchip test` prints them; empty if the claim holds. */
  found: string;
}

/** The compiler. Every method rejects with an `Error` whose message can be shown. */
export interface Compiler {
  language(): Promise<Language>;
  compile(request: CompileRequest): Promise<Compiled>;
  /** The whole module of a program without mistakes, of which there is the run form already. */
  whole(request: CompileRequest): Promise<Uint8Array<ArrayBuffer>>;
  /**
   * Bounds of a frame's cycles, of the program of a request; null if there are none. It may take
   * seconds, in which the compiler does nothing else.
   */
  bounds(of: CompileRequest): Promise<Bounds | null>;
  /** Parse a condition for the program of a request. */
  condition(text: string, of: CompileRequest): Promise<ConditionTree>;
  /** Addresses of the instructions of a request's program that can write a cell or pixel. */
  writers(value: Quantity, of: CompileRequest): Promise<number[]>;
  /** Read the test lines of the program; diagnostics instead if they have mistakes. */
  tests(request: CompileRequest): Promise<{ runs: TestRun[]; diagnostics: Diagnostic[] }>;
  /** Judge the expectations of a run, as `npchip test` does. */
  judge(run: string, machine: string, result: RunDocument): Promise<Verdict[]>;
}

// ---- frames

/** Frames of the sensor's size, one after the other, row by row. */
export interface Clip {
  name: string;
  count: number;
  rows: number;
  cols: number;
  data: Uint8Array<ArrayBuffer>;
  /** Frames a second, if the file says: the pace `As the clip` takes it. */
  fps: number | null;
}

// ---- the chip: the module at work, in a worker of its own

/** The chip between two instructions. Planes are row by row, one byte an NP. */
export interface ChipView {
  address: number;
  stack: number[];
  /** Number of open masked regions. */
  depth: number;
  /** Address of the instruction executed last; null if none was, left out if it is not known. */
  last?: number | null;
  /** Index of the exposed frame; -1 before the first. */
  frame: number;
  frameCycles: number;
  frameInstructions: number;
  cycles: number;
  instructions: number;
  /** True if the run is over; `status` says how. */
  ended: boolean;
  status: RunDocument["status"] | null;
  error: RunDocument["error"] | null;
  /** 16 planes. */
  registers: Uint8Array;
  zero: Uint8Array;
  carry: Uint8Array;
  /** 1 for NPs that execute. */
  active: Uint8Array;
  /** Masks of the open regions, the outermost first. */
  masks: Uint8Array[];
  /** `memory_bytes` planes. */
  memory: Uint8Array;
  /** The exposed frame, row by row; null before the first. */
  exposed: Uint8Array | null;
}

/** Frames that the program has completed, in columns; the index of the first is `first`. */
export interface FrameBatch {
  first: number;
  cycles: Float64Array;
  instructions: Float64Array;
  /**
   * By output: numbers as an array (NaN for nothing sent); planes and pictures one after the
   * other with `null` where nothing was sent; lists as they are.
   */
  outputs: Record<string, OutputColumn>;
  /** The input frames of a camera, row by row; null for a clip, which the page has, or if no longer kept. */
  frames: Uint8Array | null;
  /** The setup before the first frame; in the first batch after a reset, which may have no frame. */
  setup?: FrameDocument;
}

/** A column of planes or pictures without values is one that is no longer kept. */
export type OutputColumn =
  | { kind: "scalar" | "scalar16"; values: Float64Array }
  | { kind: "list"; values: (number[] | null)[] }
  | { kind: "plane" | "picture"; rows: number; cols: number; values: (Uint8Array | null)[] };

export interface Stop {
  reason: "paused" | "step" | "breakpoint" | "condition" | "ended" | "beginning";
  /** Text for people, such as the condition that held. */
  text: string;
}

export interface Breakpoint {
  /** Addresses of a line, at each use of a macro; empty with a condition that names its own. */
  addresses: number[];
  condition: ConditionTree | null;
}

/** The distance to go; `cursor` goes to the next instruction of `addresses`. */
export type Travel =
  | { to: "step" | "over" | "out" | "frame" | "end" }
  | { to: "cursor"; addresses: number[] }
  | { to: "instruction"; number: number };

/** Steps or frames a second; `max` runs as fast as it goes. */
export type Pace = { unit: "steps" | "frames"; rate: number } | "max";

/** A write that `wrote` found: the instruction that did it. */
export interface WriteFound {
  address: number;
  frame: number;
  instruction: number;
  before: number;
  after: number;
}

/** The reason that no write was found: there is none, it may be too old, or `pause` was heard. */
export type NotFound = "never" | "not kept" | "given up";

export interface ChipEvents {
  /**
   * The chip was told to begin anew, by `load`, `frames` or `reset`. It is called in the order
   * itself; no frames, views or stops of the time before are told after it.
   */
  begun(): void;
  /** New complete frames. */
  frames(batch: FrameBatch): void;
  /** A view of the chip; at most 30 a second while it runs. */
  view(view: ChipView): void;
  stopped(stop: Stop): void;
  /** Progress of a long search: 0 to 1. */
  progress(share: number): void;
  /** A fault of the page itself. */
  failed(message: string): void;
}

/** The chip. It answers in order; `pause` is heard within 50 ms. */
export interface ChipClient {
  /** Put a program in; the chip is reset, frames and breakpoints stay. */
  load(module: Uint8Array<ArrayBuffer>, program: ProgramInfo, maxCycles: number): Promise<void>;
  /**
   * Bring the whole module of the program that was loaded last, if `load` got the run form only: all
   * that steps waits for it. Null if it is not to be had, and `why`.
   */
  stepping(module: Uint8Array<ArrayBuffer> | null, why?: string): Promise<void>;
  /** Give it a clip, or `live` frames that `feed` brings; null for no frames. The chip is reset. */
  frames(source: Clip | "live" | null): Promise<void>;
  /** Give a live frame; resolves when the program has completed it, or dropped it. */
  feed(frame: Uint8Array<ArrayBuffer>): Promise<"done" | "dropped">;
  reset(): Promise<void>;
  breakpoints(all: Breakpoint[]): Promise<void>;
  /** Run forward until a breakpoint, the end or `pause`; `stopped` tells. */
  run(pace: Pace): void;
  pause(): void;
  /** Go forward or back; `back` to `step`, `over`, `out`, `cursor`, `frame`, or `end` to the last breakpoint. */
  go(travel: Travel, back: boolean): Promise<Stop>;
  /** Find the last write to a cell of an NP or a pixel before now; `writers` are its candidates. */
  wrote(value: Quantity, writers: number[]): Promise<WriteFound | NotFound>;
  /** Cycles by address of a frame, for the bar that shows where they go. */
  profile(frame: number): Promise<Float64Array>;
  /** Run a clip to its end apart from all else, for the checks. */
  whole(
    module: Uint8Array<ArrayBuffer>,
    program: ProgramInfo,
    clip: Clip | null,
    maxCycles: number,
  ): Promise<RunDocument>;
  /** Give up what `whole` was asked for: it rejects. */
  stopWhole(): void;
  /** Stop everything at once, even a frame that never ends; the program must be loaded again. */
  terminate(): void;
}
