/** Actions of keys in the text. */

import { acceptCompletion, completionStatus } from "@codemirror/autocomplete";
import { indentLess, indentMore, insertNewlineAndIndent } from "@codemirror/commands";
import { indentService } from "@codemirror/language";
import { EditorState, type Extension, type Text } from "@codemirror/state";
import type { Command, KeyBinding } from "@codemirror/view";
import { CLOSING, indentation, toStop } from "./lines";

/** Tab goes to the next column of the style of `asm/`; with text selected it moves the lines. */
const tab: Command = (view) => {
  if (completionStatus(view.state) === "active") return acceptCompletion(view);
  if (view.state.readOnly) return false;
  const { main } = view.state.selection;
  if (!main.empty) return indentMore(view);
  const column = main.from - view.state.doc.lineAt(main.from).from;
  view.dispatch(view.state.replaceSelection(toStop(column)), { scrollIntoView: true, userEvent: "input.indent" });
  return true;
};

/** Keys of lines. Escape, then Tab leaves the editor: CodeMirror sees to that. */
export const lineKeys: readonly KeyBinding[] = [
  { key: "Tab", run: tab, shift: indentLess },
  { key: "Enter", run: insertNewlineAndIndent },
];

/** Indentation as the sources of `asm/` have it, and `;` for comments. */
export const conventions: Extension = [
  EditorState.tabSize.of(8),
  EditorState.languageData.of(() => [
    { commentTokens: { line: ";" }, closeBrackets: { brackets: ["(", "[", '"'] }, indentOnInput: CLOSING },
  ]),
  indentService.of((context, pos) => {
    // If a line is being broken at `pos`, the text before it is the line above.
    const broken = context.simulatedBreak === pos ? context.lineAt(pos, -1).text : "";
    const above = broken.trim() ? broken : textAbove(context.state.doc, pos);
    return indentation(above, context.lineAt(pos, 1).text);
  }),
];

/** Return the nearest line above a position that is not blank; empty for none. */
function textAbove(doc: Text, pos: number): string {
  for (let number = doc.lineAt(pos).number - 1; number >= 1; number--) {
    const { text } = doc.line(number);
    if (text.trim()) return text;
  }
  return "";
}
