/** The question when a breakpoint stops: a small form beside its line. */

import { type Extension, StateEffect, StateField } from "@codemirror/state";
import { type EditorView, showTooltip, type Tooltip } from "@codemirror/view";

const show = StateEffect.define<Tooltip | null>();

/** The form, if it is open. */
const form = StateField.define<Tooltip | null>({
  create: () => null,
  update(tooltip, transaction) {
    for (const effect of transaction.effects) if (effect.is(show)) return effect.value;
    return transaction.docChanged ? null : tooltip;
  },
  provide: (field) => showTooltip.from(field),
});

/** The extension that can show the form. */
export const conditionForm: Extension = form;

/**
 * Ask for the condition of a line's breakpoint.
 *
 * @param condition what it is now.
 * @param decide gets the new condition, empty for every time; null removes the breakpoint.
 */
export function askCondition(
  view: EditorView,
  line: number,
  condition: string,
  decide: (condition: string | null) => void,
): void {
  const create = (): { dom: HTMLElement; mount(): void } => {
    const close = (): void => {
      view.dispatch({ effects: show.of(null) });
      view.focus();
    };
    const dom = document.createElement("form");
    dom.className = "editor-condition";
    dom.setAttribute("role", "dialog");
    dom.setAttribute("aria-label", `Breakpoint of line ${line}`);
    const label = document.createElement("label");
    label.textContent = `Line ${line}: stop only if `;
    const input = document.createElement("input");
    input.type = "text";
    input.value = condition;
    input.placeholder = "any r3 > 100";
    input.spellcheck = false;
    label.append(input);
    const button = (text: string, type: "submit" | "button", does?: () => void): void => {
      const made = document.createElement("button");
      made.type = type;
      made.textContent = text;
      if (does) made.addEventListener("click", does);
      dom.append(made);
    };
    dom.append(label);
    button("Set", "submit");
    button("Remove", "button", () => {
      decide(null);
      close();
    });
    button("Cancel", "button", close);
    dom.addEventListener("submit", (event) => {
      event.preventDefault();
      decide(input.value.trim());
      close();
    });
    dom.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      event.preventDefault();
      close();
    });
    return { dom, mount: () => input.select() };
  };
  view.dispatch({ effects: show.of({ pos: view.state.doc.line(line).from, above: false, create }) });
}
