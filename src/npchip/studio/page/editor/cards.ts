/** The card of a word: what an instruction does, what a name is worth, what a mistake is. */

import { forEachDiagnostic } from "@codemirror/lint";
import { type Extension, StateEffect, StateField } from "@codemirror/state";
import { EditorView, hoverTooltip, type Command, type Tooltip, showTooltip } from "@codemirror/view";
import type { Entry, ProgramInfo } from "../protocol";
import { codeEnd, spot, wordAt } from "./lines";
import { lookUp, type Name } from "./names";

/** Contents of a card. */
export interface Card {
  title: string;
  lines: string[];
  /** Forms of an instruction. */
  syntax: string[];
  /** The manual page; empty for none. */
  page: string;
}

/** Material for cards, at the time when one is shown. */
export interface Known {
  entries: readonly Entry[];
  names: readonly Name[];
  program: ProgramInfo | null;
  file: string;
}

/** Return the card of the word at an offset of a line, or null. */
export function cardAt(line: string, number: number, offset: number, known: Known): Card | null {
  const word = wordAt(line, offset);
  if (!word || word.from >= codeEnd(line)) return null;
  const text = line.slice(word.from, word.to);
  const at = spot(line, word.to);
  if (at.kind === "none") return null;
  const name = lookUp(known.names, text, known.file, number);
  // A name may be spelt like an instruction or a direction; the place in the line decides.
  const fits = at.kind !== "first" || name?.kind === "macro" || name?.kind === "label";
  if (name && fits) return nameCard(name, known.file);
  const lower = text.toLowerCase();
  const first = at.kind === "first";
  const entry = known.entries.find(
    (entry) =>
      entry.name.toLowerCase() === lower &&
      first === (entry.kind === "instruction" || entry.kind === "directive"),
  );
  return entry ? entryCard(entry, known.program) : null;
}

function entryCard({ name, kind, summary, syntax, page }: Entry, program: ProgramInfo | null): Card {
  const lines = [summary];
  const cycles = kind === "instruction" && program ? cyclesOf(name, program) : "";
  if (cycles) lines.push(cycles);
  return { title: `${name} · ${kind}`, lines, syntax, page };
}

/** Return the cycles of an instruction, as the words of the program have them on its machine. */
function cyclesOf(name: string, { words, machine }: ProgramInfo): string {
  const found = words.filter(({ text }) => text.split(/\s/, 1)[0]?.toUpperCase() === name.toUpperCase());
  const cycles = [...new Set(found.map((word) => word.cycles))].sort((a, b) => a - b);
  if (!cycles.length) return "";
  return `${cycles.join(" or ")} ${cycles.at(-1) === 1 ? "cycle" : "cycles"} on ${machine.name}`;
}

function nameCard({ name, kind, text, operands, place }: Name, file: string): Card {
  const head = kind === "macro" ? `${name} ${operands.join(", ")}`.trim() : name;
  const worth = text && kind !== "macro" ? [text] : [];
  const where = place.file === file ? `line ${place.line}` : `${place.file}, line ${place.line}`;
  const lines = [...worth, `Defined in ${where} · F12 goes there`];
  return { title: `${head} · ${kind}`, lines, syntax: [], page: "" };
}

/** Return a card as it is shown. */
export function cardDom({ title, lines, syntax, page }: Card): HTMLElement {
  const dom = document.createElement("div");
  dom.className = "editor-card";
  const add = (tag: string, text: string, parent: Element = dom): HTMLElement => {
    const part = document.createElement(tag);
    part.textContent = text;
    parent.append(part);
    return part;
  };
  add("strong", title);
  for (const line of lines.filter(Boolean)) add("p", line);
  if (syntax.length) add("pre", syntax.join("\n"));
  if (page) {
    const details = document.createElement("details");
    add("summary", "Manual page", details);
    add("pre", page, details).className = "editor-card-page";
    dom.append(details);
  }
  return dom;
}

const showCard = StateEffect.define<Tooltip | null>();

/** The card that was asked for by key. It takes the focus; Escape gives it back. */
const asked = StateField.define<Tooltip | null>({
  create: () => null,
  update(tooltip, transaction) {
    for (const effect of transaction.effects) if (effect.is(showCard)) return effect.value;
    return transaction.docChanged || transaction.selection ? null : tooltip;
  },
  provide: (field) => showTooltip.from(field),
});

/** Close the card that was asked for. */
export const closeCard: Command = (view) => {
  if (!view.state.field(asked)) return false;
  view.dispatch({ effects: showCard.of(null) });
  view.focus();
  return true;
};

/** Return the command that shows what is at the cursor: its mistakes, and the card of its word. */
export function cardCommand(known: () => Known): Command {
  return (view) => {
    const { head } = view.state.selection.main;
    const parts = partsAt(view, head, known());
    if (!parts.length) {
      view.dispatch({ effects: EditorView.announce.of("No help for this word.") });
      return true;
    }
    const create = (): { dom: HTMLElement; mount(): void } => {
      const dom = document.createElement("div");
      dom.setAttribute("role", "dialog");
      dom.setAttribute("aria-label", "About this word");
      dom.tabIndex = -1;
      dom.append(...parts);
      dom.addEventListener("keydown", (event) => {
        if (event.key === "Escape") {
          event.preventDefault();
          closeCard(view);
        }
      });
      dom.addEventListener("focusout", (event) => {
        if (dom.contains(event.relatedTarget as Node | null)) return;
        // Not at once: the focus may leave because the view is being updated.
        queueMicrotask(() => view.state.field(asked) && view.dispatch({ effects: showCard.of(null) }));
      });
      return { dom, mount: () => dom.focus() };
    };
    view.dispatch({ effects: showCard.of({ pos: head, above: true, create }) });
    return true;
  };
}

function partsAt(view: EditorView, pos: number, known: Known): HTMLElement[] {
  const parts: HTMLElement[] = [];
  forEachDiagnostic(view.state, (fault, from, to) => {
    if (from > pos || pos > to || !fault.renderMessage) return;
    parts.push(fault.renderMessage(view) as HTMLElement);
  });
  const line = view.state.doc.lineAt(pos);
  const card = cardAt(line.text, line.number, pos - line.from, known);
  if (card) parts.push(cardDom(card));
  return parts;
}

/** Cards for the mouse and the keyboard. */
export function cards(known: () => Known): Extension {
  return [
    asked,
    hoverTooltip((view, pos) => {
      const line = view.state.doc.lineAt(pos);
      const offset = pos - line.from;
      const card = cardAt(line.text, line.number, offset, known());
      const word = wordAt(line.text, offset);
      if (!card || !word) return null;
      const [from, end] = [line.from + word.from, line.from + word.to];
      return { pos: from, end, above: true, create: () => ({ dom: cardDom(card) }) };
    }),
  ];
}
