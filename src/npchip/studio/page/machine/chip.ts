/** The chip of the page, apart from the worker it lives in: takes orders, and tells what happens. */

import type {
  Breakpoint,
  ChipView,
  Clip,
  FrameDocument,
  NotFound,
  Pace,
  ProgramInfo,
  Quantity,
  RunDocument,
  Stop,
  Travel,
  WriteFound,
} from "../protocol";
import { Columns, type PackedBatch, documents } from "./columns";
import type { Sink } from "./core";
import { type Description, Forms } from "./description";
import { History, type Moment } from "./history";
import { Live } from "./live";
import { type Breathe, Past } from "./past";
import { Run } from "./run";
import { cyclesOf, lastWrite } from "./search";
import { ClipSource, LiveSource, NOTHING, type Source } from "./source";
import type { Stepper } from "./stepper";
import type { Sprinter } from "./sprinter";
import { back, forward, PAUSED } from "./travel";
import { Turns } from "./turns";
import { wholeRun } from "./whole";

/** Events of the chip, with frames packed for `postMessage`. */
export interface Events {
  frames(batch: PackedBatch): void;
  view(view: ChipView): void;
  stopped(stop: Stop): void;
  progress(share: number): void;
  failed(message: string): void;
}

/** Milliseconds between two batches, and between two views where instructions can be followed. */
const PERIOD = 33;
/** Milliseconds between two views where frames rush by: numbers that change faster only cost time. */
const GLANCE = 100;
/** Milliseconds between two batches of live frames, which are few and wanted soon. */
const LIVE_PERIOD = 15;
/** Bytes of frames that may wait to be told. */
const BULK = 8 << 20;
/** Batches on their way that the page has not taken. */
const UNREAD = 4;

interface Loaded {
  forms: Forms;
  program: ProgramInfo;
  limit: number;
}

export class Chip {
  readonly turns = new Turns();
  readonly live = new Live(this.turns);
  breaks: Breakpoint[] = [];
  /** Counts orders to begin anew, refused ones too: the page counts them as well, so it can tell. */
  era = 0;
  /** Counts runs, for the same reason. */
  runs = 0;
  /** Whole runs that were asked for, and the last of them that was given up. */
  #wholes = 0;
  #stopped = 0;
  /** Batches that were told and not yet taken. */
  #unread = 0;
  #loaded: Loaded | null = null;
  #given: Clip | "live" | null = null;
  #past: Past | null = null;
  #present: Stepper | Sprinter | null = null;
  #columns: Columns | null = null;
  /** The setup before the first frame, until it has been reported. */
  #setup: FrameDocument | null = null;
  #published = 0;
  #toldAt = 0;
  #viewedAt = 0;
  /** Milliseconds between two views at the present pace. */
  #viewPeriod = PERIOD;
  /** The moment that was seen last. */
  #viewedTime = 0;

  constructor(
    readonly events: Events,
    private readonly memory: { spacing?: number; budget?: number } = {},
  ) {}

  // ---- orders

  load(module: Uint8Array<ArrayBuffer>, program: ProgramInfo, maxCycles: number): Promise<void> {
    return this.turns.order(async () => {
      this.era++;
      this.#loaded = { forms: new Forms(module), program, limit: maxCycles };
      this.#begin();
    });
  }

  /** Add the stepping form to a program that was loaded without. It does not wait for orders. */
  stepping(module: Uint8Array<ArrayBuffer> | null, why: string): void {
    this.#loaded?.forms.complete(module, why);
  }

  frames(source: Clip | "live" | null): Promise<void> {
    return this.turns.order(async () => {
      this.era++;
      const about = this.#loaded?.forms.run.about;
      if (source && source !== "live" && about) checkSize(source, about);
      this.#given = source;
      if (this.#loaded) this.#begin();
    });
  }

  async feed(frame: Uint8Array): Promise<"done" | "dropped"> {
    const bytes = this.#loaded?.forms.run.about.frames.bytes ?? frame.length;
    if (frame.length !== bytes) {
      throw new Error(`a live frame has ${frame.length} pixels; the chip takes ${bytes}`);
    }
    return this.live.offer(frame);
  }

  reset(): Promise<void> {
    return this.turns.order(async () => {
      this.era++;
      this.#begin();
    });
  }

  breakpoints(all: Breakpoint[]): void {
    this.breaks = all;
    this.turns.wake();
  }

  run(pace: Pace): Promise<void> {
    return this.turns.order(async (breathe) => {
      this.#viewPeriod = pace !== "max" && pace.unit === "steps" ? PERIOD : GLANCE;
      this.runs++;
      const stop = await new Run(this, this.#now.past, pace, breathe).go();
      this.show(true);
      this.events.stopped(stop);
    }, true);
  }

  pause(): void {
    this.turns.stop();
  }

  /** The page has taken a batch. */
  taken(): void {
    this.#unread = Math.max(0, this.#unread - 1);
    this.turns.wake();
  }

  go(travel: Travel, isBack: boolean): Promise<Stop> {
    const isRun = travel.to === "end" && !isBack;
    return this.turns.order(async (breathe) => {
      const { past } = this.#now;
      const stop = isRun
        ? await new Run(this, past, "max", breathe).go()
        : await this.#move(past, travel, isBack, breathe);
      this.show(true);
      return stop;
    }, isRun);
  }

  async #move(past: Past, travel: Travel, isBack: boolean, breathe: Breathe): Promise<Stop> {
    const around = {
      breathe: () => {
        this.flush();
        return breathe();
      },
      frame: () => this.nextFrame(breathe),
      progress: (share: number) => this.events.progress(share),
    };
    if (await past.steppable(around.breathe)) return PAUSED;
    const move = isBack ? back : forward;
    const { chip, stop } = await move(past, this.stepper(), travel, this.breaks, around);
    this.#present = chip;
    this.live.rest();
    return stop;
  }

  wrote(value: Quantity, writers: number[]): Promise<WriteFound | NotFound> {
    return this.turns.order(async (breathe) => {
      const { past, present } = this.#now;
      if (await past.steppable(breathe)) return "given up";
      const { program } = this.#loaded as Loaded;
      const tell = (share: number) => this.events.progress(share);
      return lastWrite(past, present.time, value, writers, program, breathe, tell);
    });
  }

  profile(frame: number): Promise<Float64Array<ArrayBuffer>> {
    return this.turns.aside(async (breathe) => {
      const { past, present } = this.#now;
      const isOver = async () => (await breathe()) || this.#past !== past;
      if (await past.steppable(isOver)) throw new Error("another program is in the chip");
      const { words } = (this.#loaded as Loaded).program;
      // Frames that the page knows are complete; of the present one, what was executed counts.
      const until = frame < this.#published ? Infinity : present.time;
      return cyclesOf(past, frame, until, words.length, breathe);
    });
  }

  whole(
    module: Uint8Array<ArrayBuffer>,
    clip: Clip | null,
    maxCycles: number,
  ): Promise<RunDocument> {
    const mine = ++this.#wholes;
    return this.turns.aside(async (letIn) => {
      const breathe = async () => (await letIn()) || mine <= this.#stopped;
      const forms = new Forms(module);
      if (clip) checkSize(clip, forms.run.about);
      const source = clip ? new ClipSource(clip) : NOTHING;
      return wholeRun(forms, source, maxCycles, breathe);
    });
  }

  /** Give up the whole runs that were asked for. */
  stopWhole(): void {
    this.#stopped = this.#wholes;
  }

  // ---- for what moves the chip

  get #now(): { past: Past; present: Stepper | Sprinter } {
    if (!this.#past || !this.#present) throw new Error("no program is in the chip: assemble one");
    return { past: this.#past, present: this.#present };
  }

  get present(): Stepper | Sprinter {
    return this.#now.present;
  }

  set present(chip: Stepper | Sprinter) {
    this.#present = chip;
  }

  /** The present chip in the stepping form. */
  stepper(): Stepper {
    const { past, present } = this.#now;
    if ("drive" in present) return present;
    const stepper = past.handover(present, "held", null);
    this.#present = stepper;
    return stepper;
  }

  /** Tell frames and a view if it is time, or at once. */
  show(now = false): void {
    const clock = performance.now();
    this.flush(now);
    if (!now && clock - this.#viewedAt < this.#viewPeriod) return;
    this.#viewedAt = clock;
    this.#viewedTime = this.present.time;
    this.events.view(this.present.view());
  }

  /** Tell complete frames if it is time, or at once. */
  flush(now = false): void {
    const columns = this.#columns;
    // A setup alone can wait for frames, unless none comes.
    if (!columns || !(columns.count || (now && this.#setup))) return;
    const clock = performance.now();
    const period = this.#given === "live" ? LIVE_PERIOD : PERIOD;
    if (!now && clock - this.#toldAt < period && columns.size < BULK) return;
    this.#toldAt = clock;
    this.#unread++;
    const setup = this.#setup;
    this.#setup = null;
    this.events.frames({ ...columns.take(), ...(setup && { setup }) });
  }

  /** Milliseconds until there is something to tell; Infinity if all was told. */
  get due(): number {
    const clock = performance.now();
    const frames = this.#columns?.count ? LIVE_PERIOD - (clock - this.#toldAt) : Infinity;
    const isSeen = this.#viewedTime === this.present.time;
    const view = isSeen ? Infinity : this.#viewPeriod - (clock - this.#viewedAt);
    return Math.max(1, Math.min(frames, view));
  }

  /** True if the page does not keep up with the frames. */
  get isAhead(): boolean {
    return this.#unread > UNREAD;
  }

  /** Wait until there is a live frame, and take it; true if that is given up. */
  async nextFrame(breathe: Breathe): Promise<boolean> {
    const { source } = this.#now.past;
    if (!(source instanceof LiveSource)) return true;
    for (;;) {
      if (this.live.take(source)) {
        this.#past?.history.forget(source.oldest);
        return false;
      }
      this.show();
      await this.turns.sleep(this.due);
      if (await breathe()) return true;
    }
  }

  #begin(): void {
    if (!this.#loaded) throw new Error("no program is in the chip: assemble one");
    const { forms, limit } = this.#loaded;
    const { about } = forms.run;
    this.live.clear();
    const columns = new Columns(about);
    const source = sourceOf(this.#given, about);
    this.#columns = columns;
    this.#published = 0;
    this.#setup = null;
    let begun = false;
    const sink: Sink = {
      frame: (index, cycles, instructions, sends) => {
        if (index < 0 && !begun) {
          const alone = new Columns(about);
          alone.add(sends, cycles, instructions);
          this.#setup = documents(alone.take())[0] ?? null;
          begun = true;
        }
        if (index !== this.#published) return; // the setup, or one that was told before
        this.#published++;
        const input = source.kind === "live" ? source.get(index) : null;
        columns.add(sends, cycles, instructions, input);
        this.live.complete(index);
      },
      frames: (index, alike) => {
        const told = this.#published - index;
        columns.addAlike(alike, told);
        this.#published += Math.max(0, alike.count - told);
      },
    };
    const { spacing, budget } = this.memory;
    const history = (beginning: Moment) => new History(beginning, spacing, budget);
    this.#past = new Past(forms, limit, source, sink, history);
    this.#present = this.#past.sprinter();
    this.show(true);
  }
}

function sourceOf(given: Clip | "live" | null, about: Description): Source {
  if (given === "live") return new LiveSource(about.frames.bytes);
  // A clip of another size waits for the program that it was made for.
  if (!given || !fits(given, about)) return NOTHING;
  return new ClipSource(given);
}

function fits(clip: Clip, about: Description): boolean {
  return clip.rows === 8 * about.np_rows && clip.cols === 8 * about.np_cols;
}

function checkSize(clip: Clip, about: Description): void {
  if (fits(clip, about)) return;
  throw new Error(
    `the clip ${clip.name} has frames of ${clip.rows} × ${clip.cols} pixels; ` +
      `the chip takes ${8 * about.np_rows} × ${8 * about.np_cols}: choose the clip again`,
  );
}
