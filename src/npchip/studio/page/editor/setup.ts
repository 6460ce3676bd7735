/** The parts of CodeMirror that the editor uses, and its keys. */

import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, toggleComment } from "@codemirror/commands";
import { bracketMatching, indentOnInput } from "@codemirror/language";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { EditorState, type Extension, Prec } from "@codemirror/state";
import {
  type Command,
  crosshairCursor,
  drawSelection,
  dropCursor,
  EditorView,
  highlightActiveLine,
  highlightActiveLineGutter,
  highlightSpecialChars,
  keymap,
  rectangularSelection,
} from "@codemirror/view";
import { cards, closeCard, cardCommand, type Known } from "./cards";
import { completing } from "./completion";
import { conditionForm } from "./condition";
import { columns } from "./gutters";
import { conventions, lineKeys } from "./keys";
import { marks } from "./marks";

/** Requests of keys and clicks to the panel. */
export interface Wishes {
  known(): Known & { files: readonly string[] };
  toggleBreak(view: EditorView, line: number): void;
  askBreak(view: EditorView, line: number): void;
  nextFault(view: EditorView, step: 1 | -1): boolean;
  define(view: EditorView, pos: number): boolean;
  back(view: EditorView): boolean;
}

/** Return the extensions of every file's state. `help` is the id of the text about keys. */
export function setup(wishes: Wishes, help: string): Extension {
  const atCursor =
    (does: (view: EditorView, line: number) => void): Command =>
    (view) => {
      does(view, view.state.doc.lineAt(view.state.selection.main.head).number);
      return true;
    };
  return [
    columns(wishes.toggleBreak, wishes.askBreak),
    marks,
    conditionForm,
    history(),
    drawSelection(),
    dropCursor(),
    EditorState.allowMultipleSelections.of(true),
    rectangularSelection(),
    crosshairCursor(),
    highlightSpecialChars(),
    highlightActiveLine(),
    highlightActiveLineGutter(),
    highlightSelectionMatches({ minSelectionLength: 2 }),
    bracketMatching(),
    closeBrackets(),
    conventions,
    indentOnInput(),
    search({ top: true }),
    autocompletion({
      override: [
        completing({
          entries: () => wishes.known().entries,
          names: () => wishes.known().names,
          files: () => wishes.known().files,
        }),
      ],
      icons: false,
    }),
    cards(wishes.known),
    EditorView.contentAttributes.of({ "aria-label": "Program", "aria-describedby": help, tabindex: "0" }),
    // Ctrl-click goes to a definition, so it sets no second cursor; Alt-click does.
    EditorView.clickAddsSelectionRange.of((event) => event.altKey),
    EditorView.domEventHandlers({
      mousedown(event, view) {
        if (!(event.ctrlKey || event.metaKey) || event.button !== 0) return false;
        const pos = view.posAtCoords(event);
        return pos !== null && wishes.define(view, pos);
      },
    }),
    Prec.high(
      keymap.of([
        { key: "F1", run: cardCommand(wishes.known) },
        { key: "Mod-i", run: cardCommand(wishes.known) },
        { key: "Escape", run: closeCard },
        { key: "F8", run: (view) => wishes.nextFault(view, 1), shift: (view) => wishes.nextFault(view, -1) },
        { key: "F9", run: atCursor(wishes.toggleBreak), shift: atCursor(wishes.askBreak) },
        { key: "F12", run: (view) => wishes.define(view, view.state.selection.main.head) },
        { key: "Alt-ArrowLeft", run: wishes.back },
        { key: "Mod-/", run: toggleComment },
      ]),
    ),
    keymap.of([
      ...closeBracketsKeymap,
      ...completionKeymap,
      ...searchKeymap,
      ...historyKeymap,
      ...lineKeys,
      ...defaultKeymap,
    ]),
  ];
}
