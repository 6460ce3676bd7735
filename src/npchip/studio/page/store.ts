/**
 * The page's state, as signals. Panels read them; what puts rooms together writes them. Only the
 * editor knows where its cursor is and where its breakpoints went, and the menu of a value what came
 * of a condition: they write those. `tests/studio/test_architecture.py` holds this.
 */

import { computed, signal } from "@preact/signals";
import type {
  Cell,
  ChipView,
  Clip,
  Compiled,
  Diagnostic,
  FrameBatch,
  Language,
  MachineChoice,
  Pace,
  ProgramInfo,
  Project,
  Stop,
  Verdict,
} from "./protocol";

export const project = signal<Project>({ main: "program.s", files: { "program.s": "" } });
/** Name of the file that the editor shows. */
export const openFile = signal("program.s");
/** The line that the editor was asked to bring into view; a new object each time. */
export const wantedLine = signal<{ file: string; line: number } | null>(null);
/** Sources that come with npchip, by the names that programs include them under; read only. */
export const library = signal<Record<string, string>>({});
export const language = signal<Language | null>(null);
/** The newest result of the compiler, with mistakes or without. */
export const compiled = signal<Compiled | null>(null);
/** The program in the chip: the last one without mistakes. */
export const program = signal<ProgramInfo | null>(null);
export const diagnostics = computed<Diagnostic[]>(() => compiled.value?.diagnostics ?? []);
export const machine = signal<MachineChoice>({ name: "default" });

/** The clip that the chip gets; `live` for the camera. */
export const clip = signal<Clip | "live" | null>(null);
export const running = signal(false);
export const pace = signal<Pace>({ unit: "frames", rate: 30 });
/** The chip as it was seen last; while it runs at most 30 a second. */
export const view = signal<ChipView | null>(null);
export const stop = signal<Stop | null>(null);
/** Complete frames since the last reset, in order, without gaps. `frameCount` grows with them. */
export const batches = signal<FrameBatch[]>([]);
export const frameCount = computed(() => {
  const last = batches.value[batches.value.length - 1];
  return last ? last.first + last.cycles.length : 0;
});
/** The frame whose outputs are shown: an index, or null for the newest. */
export const shownFrame = signal<number | null>(null);

/** Lines with a breakpoint, with a condition of the debugger's language or none. */
export interface LineBreak {
  file: string;
  line: number;
  condition: string;
}
export const breaks = signal<LineBreak[]>([]);
/** Conditions that stop anywhere, in the debugger's language. */
export const conditions = signal<string[]>([]);
/** Breakpoints and conditions that are kept but do not stop, by `breakKey` or the condition's text. */
export const disabled = signal<ReadonlySet<string>>(new Set());
/** Name of the breakpoint of a line in `disabled`. */
export function breakKey(file: string, line: number): string {
  return `${file}:${line}`;
}
/** The line with the editor's cursor, for runs up to there; null before there is one. */
export const cursor = signal<{ file: string; line: number } | null>(null);

/** The NP that is looked at. */
export const chosen = signal({ row: 0, column: 0 });
/** The cell that the array shows in each NP. */
export const shownCell = signal<Cell>({ kind: "register", index: 0 });

export const verdicts = signal<Verdict[] | null>(null);

export interface Message {
  kind: "info" | "error";
  text: string;
}
/** The text of the status line. */
export const message = signal<Message>({ kind: "info", text: "" });
/** Long work: what it is, how far it is (0 to 1, or null if unknown), and what stops it. */
export interface Work {
  text: string;
  share: number | null;
  cancel: (() => void) | null;
}
/** The work that the status line shows; null if there is none. */
export const progress = signal<Work | null>(null);
