/**
 * The columns beside the text. They are drawn for the eye and the mouse only: CodeMirror hides them
 * from screen readers, for which the status strip says the same of the line with the cursor.
 */

import { forEachDiagnostic, setDiagnosticsEffect } from "@codemirror/lint";
import type { EditorState, Extension } from "@codemirror/state";
import { type EditorView, gutter, GutterMarker, lineNumbers } from "@codemirror/view";
import { breakpoints, position, sums } from "./marks";
import { type LineSum, sumText, sumWords } from "./sums";

/** A text with a class and a tip. */
class Mark extends GutterMarker {
  constructor(
    readonly text: string,
    readonly name: string,
    readonly tip: string,
  ) {
    super();
  }
  override eq(other: Mark): boolean {
    return other.text === this.text && other.name === this.name && other.tip === this.tip;
  }
  override toDOM(): Node {
    const dom = document.createElement("span");
    dom.className = this.name;
    dom.textContent = this.text;
    dom.title = this.tip;
    return dom;
  }
}

function stopMark(state: EditorState, from: number): Mark | null {
  const condition = state.field(breakpoints).get(from);
  const here = state.field(position).get(from);
  if (condition === undefined && here === undefined) return null;
  // The shapes differ, so that nobody needs to tell the colours apart.
  const stop = condition === undefined ? "" : condition === "" ? "●" : "◆";
  const at = here === undefined ? "" : here ? "▶" : "▷";
  const tips = [
    condition === undefined ? "" : condition === "" ? "Breakpoint" : `Stops only if ${condition}`,
    here === undefined ? "" : here ? "The program is here" : "The program is in what this line makes",
  ];
  const name = `editor-stop${condition === undefined ? "" : " editor-stop-set"}`;
  return new Mark(stop + at, name, tips.filter(Boolean).join(" · "));
}

function cyclesMark(state: EditorState, from: number): Mark | null {
  const sum: LineSum | undefined = state.field(sums).get(from);
  return sum ? new Mark(sumText(sum), "editor-cycles", sumWords(sum)) : null;
}

function faultMark(state: EditorState, from: number, to: number): Mark | null {
  let worst: string | null = null;
  forEachDiagnostic(state, (diagnostic, begin) => {
    if (begin < from || begin > to) return;
    if (worst === null || diagnostic.severity === "error") worst = diagnostic.severity;
  });
  if (worst === null) return null;
  return worst === "error"
    ? new Mark("✕", "editor-fault-error", "A mistake")
    : new Mark("▲", "editor-fault-warning", "A warning");
}

/**
 * The columns.
 *
 * @param toggle turns the breakpoint of a line on or off.
 * @param ask opens the condition of a line's breakpoint.
 */
export function columns(
  toggle: (view: EditorView, line: number) => void,
  ask: (view: EditorView, line: number) => void,
): Extension {
  const onLine =
    (does: (view: EditorView, line: number) => void) =>
    (view: EditorView, block: { from: number }): boolean => {
      does(view, view.state.doc.lineAt(block.from).number);
      return true;
    };
  return [
    gutter({
      class: "editor-stops",
      lineMarker: (view, block) => stopMark(view.state, block.from),
      lineMarkerChange: ({ startState, state }) =>
        startState.field(breakpoints) !== state.field(breakpoints) ||
        startState.field(position) !== state.field(position),
      initialSpacer: () => new Mark("●▶", "editor-stop", ""),
      domEventHandlers: { click: onLine(toggle), contextmenu: onLine(ask) },
    }),
    lineNumbers({ domEventHandlers: { click: onLine(toggle), contextmenu: onLine(ask) } }),
    gutter({
      class: "editor-faults",
      lineMarker: (view, block) => faultMark(view.state, block.from, block.to),
      lineMarkerChange: (update) =>
        update.transactions.some((one) => one.effects.some((effect) => effect.is(setDiagnosticsEffect))),
    }),
    gutter({
      class: "editor-sums",
      lineMarker: (view, block) => cyclesMark(view.state, block.from),
      lineMarkerChange: ({ startState, state }) => startState.field(sums) !== state.field(sums),
    }),
  ];
}

/** Return what the columns show beside a line, in words. */
export function lineText(state: EditorState, from: number): string {
  const sum = state.field(sums).get(from);
  const condition = state.field(breakpoints).get(from);
  const here = state.field(position).get(from);
  return [
    `Line ${state.doc.lineAt(from).number}`,
    sum ? sumWords(sum) : "",
    condition === undefined ? "" : condition === "" ? "breakpoint" : `stops only if ${condition}`,
    here === undefined ? "" : here ? "the program is here" : "the program is in what this line makes",
  ]
    .filter(Boolean)
    .join(" · ");
}
