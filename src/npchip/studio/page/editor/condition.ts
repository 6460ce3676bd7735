/** The question when a breakpoint stops: a small form beside its line. */

import { type Extension, StateEffect, StateField } from "@codemirror/state";
import { type EditorView, showTooltip, type Tooltip } from "@codemirror/view";
import { heard } from "../say";

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

/** Outcomes of the form. */
export interface Decision {
  /** Give the breakpoint a condition, empty for every time. Resolves to what is wrong, or null. */
  set(condition: string): Promise<string | null>;
  remove(): void;
}

/** Ask for the condition of a line's breakpoint; `condition` is what it is now. */
export function askCondition(view: EditorView, line: number, condition: string, decision: Decision): void {
  const create = (): { dom: HTMLElement; mount(): void } => {
    const close = (): void => {
      view.dispatch({ effects: show.of(null) });
      view.focus();
    };
    const form = document.createElement("form");
    form.className = "editor-condition";
    form.setAttribute("role", "dialog");
    form.setAttribute("aria-label", `Breakpoint of line ${line}`);
    const label = document.createElement("label");
    label.textContent = `Line ${line}: stop only if `;
    const input = document.createElement("input");
    input.type = "text";
    input.value = condition;
    input.placeholder = "any r3 > 100";
    input.spellcheck = false;
    input.autocapitalize = "off";
    label.append(input);
    const fault = document.createElement("p");
    fault.setAttribute("role", "alert");
    fault.className = "editor-fault-error";
    form.append(
      label,
      button("Set", "submit"),
      button("Remove", "button", () => {
        decision.remove();
        close();
      }),
      button("Cancel", "button", close),
      fault,
    );
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const set = decision.set(input.value.trim()).then((wrong) => {
        if (wrong === null) close();
        else {
          fault.textContent = wrong;
          input.setAttribute("aria-invalid", "true");
          input.focus();
        }
      });
      heard(set);
    });
    form.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      event.preventDefault();
      close();
    });
    return { dom: form, mount: () => input.select() };
  };
  view.dispatch({ effects: show.of({ pos: view.state.doc.line(line).from, above: false, create }) });
}

function button(text: string, type: "submit" | "button", does?: () => void): HTMLButtonElement {
  const made = document.createElement("button");
  made.type = type;
  made.textContent = text;
  if (does) made.addEventListener("click", does);
  return made;
}
