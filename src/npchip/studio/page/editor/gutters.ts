/**
 * The columns beside the text. They are drawn for the eye and the mouse only: CodeMirror hides them
 * from screen readers, for which the status strip says the same of the line with the cursor.
 */

import { forEachDiagnostic, setDiagnosticsEffect } from "@codemirror/lint";
import type { EditorState, Extension } from "@codemirror/state";
import { type EditorView, gutter, GutterMarker, lineNumbers } from "@codemirror/view";
import { breakpoints, type LineStop, position, sums } from "./marks";
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
  const stop = state.field(breakpoints).get(from);
  const here = state.field(position).get(from);
  if (!stop && here === undefined) return null;
  // The shapes differ, so that nobody needs to tell the colours apart.
  const shapes = stop?.condition ? "◆◇" : "●○";
  const shape = stop ? shapes[Number(stop.off)] : "";
  const at = here === undefined ? "" : here ? "▶" : "▷";
  const name = `editor-stop${stop ? " editor-stop-set" : ""}`;
  return new Mark(`${shape}${at}`, name, [stopText(stop), hereText(here)].filter(Boolean).join(" · "));
}

function stopText(stop: LineStop | undefined): string {
  if (!stop) return "";
  const kind = stop.condition ? `stops only if ${stop.condition}` : "breakpoint";
  return stop.off ? `${kind} (off)` : kind;
}

function hereText(here: boolean | undefined): string {
  if (here === undefined) return "";
  return here ? "the program is here" : "the program is in what this line makes";
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
  return [
    `Line ${state.doc.lineAt(from).number}`,
    sum ? sumWords(sum) : "",
    stopText(state.field(breakpoints).get(from)),
    hereText(state.field(position).get(from)),
  ]
    .filter(Boolean)
    .join(" · ");
}
