/** Mistakes in the text: underlined, told in a tip, and found by key. */

import { type Diagnostic as Underline, setDiagnostics } from "@codemirror/lint";
import type { EditorState, Text, TransactionSpec } from "@codemirror/state";
import type { Diagnostic, Place } from "../protocol";

/** Return the offsets of a place; what has left the text meanwhile is cut off. */
export function range(doc: Text, place: Place): { from: number; to: number } {
  const line = doc.line(Math.min(Math.max(place.line, 1), doc.lines));
  const from = Math.min(line.from + Math.max(place.column - 1, 0), line.to);
  const to = Math.min(from + Math.max(place.length, 1), line.to);
  // A mistake at the end of a line, such as a missing operand, marks its last character.
  return from === to && from > line.from ? { from: from - 1, to } : { from, to };
}

/** Return the mistakes of a file in the order of their places. */
export function faultsOf(diagnostics: readonly Diagnostic[], file: string, main: string): Diagnostic[] {
  return diagnostics
    .filter(({ place }) => (place?.file ?? main) === file)
    .sort((a, b) => (a.place?.line ?? 0) - (b.place?.line ?? 0) || (a.place?.column ?? 0) - (b.place?.column ?? 0));
}

/** Return the transaction that underlines the mistakes of a file. */
export function underlining(state: EditorState, faults: readonly Diagnostic[]): TransactionSpec {
  const underlines = faults.flatMap((fault): Underline[] => {
    if (!fault.place) return [];
    const { from, to } = range(state.doc, fault.place);
    const { severity, message } = fault;
    return [{ from, to, severity, message, renderMessage: () => faultDom(fault) }];
  });
  return setDiagnostics(state, underlines);
}

/** Return a mistake in words. */
export function faultText({ severity, code, message, help }: Diagnostic): string {
  const kind = severity === "error" ? "Error" : "Warning";
  return `${kind} ${code}: ${message}${help ? `; ${help}` : ""}`;
}

/** Return a mistake as it is shown in a tip. */
function faultDom({ severity, code, message, help, notes }: Diagnostic): HTMLElement {
  const dom = document.createElement("div");
  dom.className = "editor-fault";
  const add = (name: string, text: string): void => {
    const part = document.createElement("div");
    part.className = name;
    part.textContent = text;
    dom.append(part);
  };
  add(`editor-fault-${severity}`, `${severity === "error" ? "✕ Error" : "▲ Warning"} ${code}`);
  add("editor-fault-message", message);
  if (help) add("editor-fault-help", help);
  for (const note of notes) add("editor-fault-note", `${note.place.file}, line ${note.place.line}: ${note.message}`);
  return dom;
}
