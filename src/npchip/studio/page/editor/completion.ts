/** Completion: what may stand at the cursor, with the operands of an instruction to fill in. */

import {
  type Completion,
  type CompletionContext,
  type CompletionResult,
  type CompletionSource,
  snippet,
} from "@codemirror/autocomplete";
import type { Definition, Entry } from "../protocol";
import { type Spot, split, spot, STOPS } from "./lines";
import type { Name } from "./names";

/** A word that may stand at the cursor. */
export interface Offer {
  label: string;
  kind: Entry["kind"] | Definition["kind"] | "file";
  /** Operands, or what the name is worth. */
  detail: string;
  summary: string;
  /** Fields to fill in behind the word; empty for none. */
  operands: string[];
}

const REGISTER = /^r[a-z]?$|^register$/i;
const CONDITION = /^(?:not_)?cc$|^condition$/i;
/** Operands of directives; an empty text stands for a new name, which nothing can complete. */
const DIRECTIVE: Record<string, readonly string[]> = {
  ".equ": ["", "expression"],
  ".reg": ["", "register"],
  ".output": ["", "port", "an output"],
  ".budget": [""],
  ".macro": [""],
  ".error": [""],
  ".ifdef": ["name"],
  ".ifndef": ["name"],
};

/** Return what may stand at a place in a line. */
export function offers(at: Spot, entries: readonly Entry[], names: readonly Name[]): Offer[] {
  if (at.kind === "none") return [];
  return at.kind === "first" ? statements(entries, names) : operands(at, entries, names);
}

function statements(entries: readonly Entry[], names: readonly Name[]): Offer[] {
  const macros = names.filter((name) => name.kind === "macro");
  return [
    ...entries
      .filter(({ kind }) => kind === "instruction" || kind === "directive")
      .flatMap((entry) => forms(entry)),
    ...macros.map(({ name, operands, place }) => ({
      label: name,
      kind: "macro" as const,
      detail: operands.join(", "),
      summary: `Macro in ${place.file}`,
      operands,
    })),
  ];
}

/** Return an offer for each form of an instruction. */
function forms({ name, kind, summary, syntax }: Entry): Offer[] {
  const texts = syntax.length ? syntax : [name];
  return texts.map((text) => {
    // The syntax of a directive may tell of several: `.macro NAME to .endm`.
    const plain = text.startsWith(`${name} `) && !/ (?:or|to) |\.\w+ .*\.\w/.test(text);
    const rest = plain ? text.slice(name.length).trim() : "";
    const operands = kind === "instruction" && rest ? split(rest).map((part) => part.trim()) : [];
    return { label: name, kind, detail: rest, summary, operands };
  });
}

function operands(at: Spot, entries: readonly Entry[], names: readonly Name[]): Offer[] {
  const wanted = wantedAt(at, entries);
  const inner = /[[(#]/.test(at.operand) || /[-+*/%&|^~<>=!]/.test(at.operand);
  const is = (pattern: RegExp): boolean => wanted === null || wanted.some((name) => pattern.test(name));
  // The summary of a word that stands for a choice begins with the operand: `direction: …`.
  const chosen = (entry: Entry, name: string): boolean => entry.kind === "word" && entry.summary.startsWith(`${name}:`);
  const plain =
    wanted === null ||
    wanted.some((name) => name !== "" && !CONDITION.test(name) && !entries.some((entry) => chosen(entry, name)));
  const address = at.operand.startsWith("[");
  const registers = address || (!inner && is(REGISTER));
  const values = plain && !(wanted?.every((name) => REGISTER.test(name)) && !inner);
  // A macro can be given an instruction or another macro.
  const macro = names.some(({ kind, name }) => kind === "macro" && name === at.head);
  const offer = ({ name, kind, summary }: Entry): Offer => ({ label: name, kind, detail: "", summary, operands: [] });
  return [
    ...entries.filter((entry) => {
      if (entry.kind === "register") return registers;
      if (entry.kind === "instruction") return macro && !inner;
      if (entry.kind === "condition") return !inner && is(CONDITION);
      if (entry.kind !== "word" || inner) return false;
      return wanted === null || wanted.some((name) => chosen(entry, name));
    }).map(offer),
    ...names.filter(({ kind, name }) => {
      if (kind === "register") return registers;
      if (kind === "macro") return macro && !inner;
      if (kind === "constant") return values;
      if (kind === "output") return at.head === ".position" && !inner;
      const target = values && !address && !at.operand.startsWith("#");
      return kind === "label" && target && (name.startsWith(".") || is(/^(?:target|expression|name)$/));
    }).map((name) => ({ label: name.name, kind: name.kind, detail: worth(name), summary: "", operands: [] })),
  ];
}

/** Return what a name is worth, without the name. */
function worth({ name, text }: Name): string {
  return text.replace(new RegExp(`^${name.replace(".", "\\.")}(?:: | = )`), "");
}

/** Return the names of the operands that may stand here, as the syntax has them; null if unknown. */
function wantedAt(at: Spot, entries: readonly Entry[]): string[] | null {
  const head = at.head.toLowerCase();
  const directive = DIRECTIVE[head];
  if (directive) return [directive[at.index] ?? ""];
  if (head.startsWith(".")) return ["expression"];
  const entry = entries.find(({ kind, name }) => kind === "instruction" && name.toLowerCase() === head);
  if (!entry) return null;
  return entry.syntax
    .map((text) => split(text.replace(/^\S+\s*/, ""))[at.index]?.trim())
    .filter((text) => text !== undefined)
    .map((text) => (text.startsWith("#") || text.startsWith("[") ? "expression" : text));
}

/** Return the template of an offer: its word, and its operands in their column as fields. */
export function template(offer: Offer, column: number): string {
  if (!offer.operands.length) return "";
  const end = column + offer.label.length;
  const blanks = " ".repeat(Math.max(1, STOPS[1] - end));
  const fields = offer.operands.map((text) => text.replace(/[A-Za-z_]\w*/g, (name) => `\${${name}}`));
  return `${offer.label}${blanks}${fields.join(", ")}`;
}

const BOOST: Partial<Record<Offer["kind"], number>> = { label: 1, constant: 2, register: 2 };

/** The editor's completion, from what is known at the time it is asked. */
export function completing(known: {
  entries(): readonly Entry[];
  names(): readonly Name[];
  files(): readonly string[];
}): CompletionSource {
  return (context: CompletionContext): CompletionResult | null => {
    const line = context.state.doc.lineAt(context.pos);
    const column = context.pos - line.from;
    const path = /^(.*\.include\s+")([^"]*)$/i.exec(line.text.slice(0, column));
    if (path) {
      const options = known.files().map((label) => ({ label, type: "file" }));
      return { from: line.from + (path[1] as string).length, options, validFor: /^[^"]*$/ };
    }
    const at = spot(line.text, column);
    if (at.from === column && !context.explicit) return null;
    // Digits that begin a number are no word to complete.
    if (/^\d/.test(line.text.slice(at.from, column))) return null;
    const options = offers(at, known.entries(), known.names()).map((offer) => completion(offer, at.from));
    return options.length ? { from: line.from + at.from, options: unique(options), validFor: /^\.?\w*$/ } : null;
  };
}

function completion(offer: Offer, column: number): Completion {
  const text = template(offer, column);
  return {
    label: offer.label,
    type: offer.kind,
    ...(offer.detail ? { detail: offer.detail } : {}),
    ...(offer.summary ? { info: offer.summary } : {}),
    ...(text ? { apply: snippet(text) } : {}),
    boost: BOOST[offer.kind] ?? 0,
  };
}

/** Local labels of one name, and a name that two files define, are offered once. */
function unique(options: Completion[]): Completion[] {
  const seen = new Set<string>();
  return options.filter(({ label, detail, type }) => {
    const key = `${type} ${label} ${type === "label" ? "" : detail}`;
    return !seen.has(key) && seen.add(key);
  });
}
