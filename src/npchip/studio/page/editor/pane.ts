/** The text itself: a CodeMirror view, and the state of every file with what can be undone in it. */

import { Annotation, Compartment, EditorState, type Extension, type StateEffect } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import type { ColourRule, Diagnostic, ProgramInfo } from "../protocol";
import { breakKey, type LineBreak } from "../store";
import { colouring } from "./colours";
import { range, underlining } from "./faults";
import { breakLines, lineNow, type LineStop, position, setBreaks, setHere, setSums } from "./marks";
import { type LineSum, lineSums, linesAt } from "./sums";

/** Marks a change that came from outside, not from the reader. */
const outside = Annotation.define<true>();

/** Receives the events of the pane. */
export interface Hearer {
  edited(file: string, text: string): void;
  /** Breakpoints of the file moved with their lines. */
  moved(file: string, stops: ReadonlyMap<number, LineStop>): void;
  /** The cursor moved, or what stands beside its line changed. */
  looked(state: EditorState): void;
}

/** The view with the states of all files that were open. */
export class Pane {
  readonly view: EditorView;
  file = "";
  private readonly states = new Map<string, { state: EditorState; scroll: StateEffect<unknown> }>();
  private readonly colours = new Compartment();
  private readonly access = new Compartment();
  private readonly summed = new Map<string, ProgramInfo | null>();
  private rules: readonly ColourRule[] = [];

  constructor(
    parent: Element,
    private readonly extension: Extension,
    private readonly hearer: Hearer,
  ) {
    this.view = new EditorView({ parent, state: this.fresh("") });
  }

  /** Show a file. A text that differs from the one here came from outside; it can be undone. */
  open(file: string, text: string, own: boolean): void {
    if (file !== this.file) {
      const kept = this.states.get(file);
      const scroll = this.view.scrollSnapshot();
      if (this.file) this.states.set(this.file, { state: this.view.state, scroll });
      this.file = file;
      this.view.setState(kept?.state ?? this.fresh(text));
      this.view.dispatch({ effects: [this.colours.reconfigure(colouring(this.rules)), ...(kept ? [kept.scroll] : [])] });
      if (!kept) this.view.scrollDOM.scrollTo(0, 0); // a new text is read from its beginning
    }
    const doc = this.view.state.toText(text);
    if (!doc.eq(this.view.state.doc)) {
      const changes = { from: 0, to: this.view.state.doc.length, insert: doc };
      this.view.dispatch({ changes, annotations: outside.of(true), userEvent: "input.load" });
    }
    if (this.view.state.readOnly === own) {
      this.view.dispatch({ effects: this.access.reconfigure(EditorState.readOnly.of(!own)) });
    }
  }

  /** Keep the state of a file under its new name. */
  renamed(from: string, to: string): void {
    const kept = this.states.get(from);
    if (kept) this.states.set(to, kept);
    this.states.delete(from);
    this.summed.delete(from);
    if (this.file === from) this.file = to;
  }

  /** Forget the states of files that are gone, with what can be undone in them. */
  keepOnly(isThere: (file: string) => boolean): void {
    for (const kept of [this.states, this.summed]) {
      for (const file of kept.keys()) if (file !== this.file && !isThere(file)) kept.delete(file);
    }
  }

  colour(rules: readonly ColourRule[]): void {
    this.rules = rules;
    this.view.dispatch({ effects: this.colours.reconfigure(colouring(rules)) });
  }

  underline(faults: readonly Diagnostic[]): void {
    this.view.dispatch(underlining(this.view.state, faults));
  }

  /** Show the cycles of lines; `repeats` tells whether a line is a `.rept`. */
  sum(program: ProgramInfo | null, repeats: (file: string, line: number) => boolean): void {
    // The lines of a program are those of its text: while there is no newer one, they move with edits.
    if (this.summed.get(this.file) === program) return;
    this.summed.set(this.file, program);
    const found = program ? lineSums(program.words, this.file, repeats) : new Map<number, LineSum>();
    this.view.dispatch({ effects: setSums.of(found) });
  }

  /** Mark the lines that an address stands for; null for none. */
  mark(program: ProgramInfo | null, address: number | null): void {
    const { here, uses } = this.linesOf(program, address);
    const { doc } = this.view.state;
    const now = [...this.view.state.field(position)].map(([from, is]) => `${doc.lineAt(from).number}${is}`);
    const next = [...uses.map((line) => `${line}false`), ...(here === null ? [] : [`${here}true`])];
    if (now.sort().join() !== next.sort().join()) this.view.dispatch({ effects: setHere.of({ here, uses }) });
  }

  /** Return the lines of the text that an address stands for. */
  linesOf(program: ProgramInfo | null, address: number | null): { here: number | null; uses: number[] } {
    const { here, uses } = linesAt(program?.words ?? [], address ?? -1, this.file);
    const now = (line: number): number | null => lineNow(this.view.state, line);
    return { here: here && now(here), uses: uses.map(now).filter((line) => line !== null) };
  }

  /** Show the breakpoints of the file. */
  break(all: readonly LineBreak[], disabled: ReadonlySet<string>): void {
    const own = all.filter(({ file }) => file === this.file);
    const wanted = new Map(
      own.map(({ file, line, condition }) => [line, { condition, off: disabled.has(breakKey(file, line)) }]),
    );
    if (!same(wanted, breakLines(this.view.state))) this.view.dispatch({ effects: setBreaks.of(wanted) });
  }

  /** Put the cursor at a line and column, in the middle of the view if it was not in it. */
  go(line: number, column = 1): void {
    const { from } = range(this.view.state.doc, { file: this.file, line, column, length: 0 });
    this.at(from);
  }

  at(pos: number): void {
    const anchor = Math.min(pos, this.view.state.doc.length);
    this.view.dispatch({ selection: { anchor } });
    this.show(anchor);
  }

  /** Bring a line into view without moving the cursor. */
  reveal(line: number): void {
    this.show(range(this.view.state.doc, { file: this.file, line, column: 1, length: 0 }).from);
  }

  /** Scroll a position to the middle, unless it can be seen. */
  private show(pos: number): void {
    const { top, bottom } = this.view.lineBlockAt(pos);
    const { scrollTop, clientHeight } = this.view.scrollDOM;
    const seen = top >= scrollTop && bottom <= scrollTop + clientHeight;
    this.view.dispatch({ effects: EditorView.scrollIntoView(pos, { y: seen ? "nearest" : "center" }) });
  }

  destroy(): void {
    this.view.destroy();
  }

  private fresh(text: string): EditorState {
    return EditorState.create({
      doc: text,
      extensions: [
        this.extension,
        this.colours.of(colouring(this.rules)),
        this.access.of(EditorState.readOnly.of(false)),
        EditorView.updateListener.of((update) => {
          if (update.docChanged) {
            const own = !update.transactions.some((one) => one.annotation(outside));
            if (own) this.hearer.edited(this.file, update.state.doc.toString());
            const before = breakLines(update.startState);
            const after = breakLines(update.state);
            if (own && !same(before, after)) this.hearer.moved(this.file, after);
          }
          this.hearer.looked(update.state);
        }),
      ],
    });
  }
}

function same(a: ReadonlyMap<number, LineStop>, b: ReadonlyMap<number, LineStop>): boolean {
  const equal = (one: LineStop, other?: LineStop): boolean =>
    one.condition === other?.condition && one.off === other.off;
  return a.size === b.size && [...a].every(([line, stop]) => equal(stop, b.get(line)));
}
