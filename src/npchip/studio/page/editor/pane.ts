/** The text itself: a CodeMirror view, and the state of every file with what can be undone in it. */

import { Annotation, Compartment, EditorState, type Extension, type StateEffect } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import type { ColourRule, Diagnostic, ProgramInfo } from "../protocol";
import type { LineBreak } from "../store";
import { colouring } from "./colours";
import { range, underlining } from "./faults";
import { breakLines, position, setBreaks, setHere, setSums } from "./marks";
import { lineSums, linesAt } from "./sums";

/** Marks a change that came from outside, not from the reader. */
const outside = Annotation.define<true>();

/** What the pane tells. */
export interface Hearer {
  edited(file: string, text: string): void;
  /** Breakpoints of the file moved with their lines. */
  moved(file: string, breaks: ReadonlyMap<number, string>): void;
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
      if (this.file) this.states.set(this.file, { state: this.view.state, scroll: this.view.scrollSnapshot() });
      this.file = file;
      this.view.setState(kept?.state ?? this.fresh(text));
      this.view.dispatch({ effects: [this.colours.reconfigure(colouring(this.rules)), ...(kept ? [kept.scroll] : [])] });
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
    if (this.file === from) this.file = to;
  }

  colour(rules: readonly ColourRule[]): void {
    this.rules = rules;
    this.view.dispatch({ effects: this.colours.reconfigure(colouring(rules)) });
  }

  underline(faults: readonly Diagnostic[]): void {
    this.view.dispatch(underlining(this.view.state, faults));
  }

  sum(program: ProgramInfo | null): void {
    this.view.dispatch({ effects: setSums.of(program ? lineSums(program.words, this.file) : new Map()) });
  }

  /** Mark the lines that an address stands for; null for none. */
  mark(program: ProgramInfo | null, address: number | null): void {
    const lines = program && address !== null ? linesAt(program.words, address, this.file) : { here: null, uses: [] };
    const now = [...this.view.state.field(position)].map(([from, here]) => `${this.view.state.doc.lineAt(from).number}${here}`);
    const next = [...lines.uses.map((line) => `${line}false`), ...(lines.here === null ? [] : [`${lines.here}true`])];
    if (now.sort().join() !== next.sort().join()) this.view.dispatch({ effects: setHere.of(lines) });
  }

  break(all: readonly LineBreak[]): void {
    const wanted = new Map(all.filter(({ file }) => file === this.file).map(({ line, condition }) => [line, condition]));
    if (!same(wanted, breakLines(this.view.state))) this.view.dispatch({ effects: setBreaks.of(wanted) });
  }

  /** Put the cursor at a line and column, in the middle of the view if it was not in it. */
  go(line: number, column = 1): void {
    const { from } = range(this.view.state.doc, { file: this.file, line, column, length: 0 });
    this.at(from);
  }

  at(pos: number): void {
    const anchor = Math.min(pos, this.view.state.doc.length);
    this.view.dispatch({ selection: { anchor }, effects: EditorView.scrollIntoView(anchor, { y: "nearest", yMargin: 60 }) });
  }

  /** Bring a line into view without moving the cursor. */
  reveal(line: number): void {
    const { from } = range(this.view.state.doc, { file: this.file, line, column: 1, length: 0 });
    this.view.dispatch({ effects: EditorView.scrollIntoView(from, { y: "nearest", yMargin: 40 }) });
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

function same(a: ReadonlyMap<number, string>, b: ReadonlyMap<number, string>): boolean {
  return a.size === b.size && [...a].every(([line, condition]) => b.get(line) === condition);
}
