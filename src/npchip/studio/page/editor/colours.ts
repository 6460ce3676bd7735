/** Colours from the instruction set file: a rule is a pattern, the first that matches counts. */

import { type Extension, RangeSetBuilder } from "@codemirror/state";
import {
  Decoration,
  type DecorationSet,
  type EditorView,
  ViewPlugin,
  type ViewUpdate,
} from "@codemirror/view";
import type { ColourRule } from "../protocol";

/** A coloured word of a line; offsets count from 0. */
export interface Token {
  from: number;
  to: number;
  kind: string;
}

interface Rule {
  kind: string;
  pattern: RegExp;
}

/** Return the rules ready to use on a whole line: `\b` must see the characters before a word. */
export function prepare(rules: readonly ColourRule[]): Rule[] {
  return rules.map((rule) => ({
    kind: rule.kind,
    pattern: new RegExp(rule.pattern, "y"),
  }));
}

/** Return the coloured words of a line. What no rule matches has no colour. */
export function tokens(line: string, rules: readonly Rule[]): Token[] {
  const found: Token[] = [];
  let at = 0;
  while (at < line.length) {
    const hit = /\s/.test(line[at] as string) ? null : match(line, at, rules);
    if (hit) found.push(hit);
    at = hit ? hit.to : at + 1;
  }
  return found;
}

function match(line: string, from: number, rules: readonly Rule[]): Token | null {
  for (const { kind, pattern } of rules) {
    pattern.lastIndex = from;
    const to = from + (pattern.exec(line)?.[0].length ?? 0);
    if (to > from) return { from, to, kind };
  }
  return null;
}

/** Colour the lines that are on the screen; `editor.css` gives each kind its colour. */
export function colouring(rules: readonly ColourRule[]): Extension {
  const prepared = prepare(rules);
  const marks = new Map(
    rules.map(({ kind }) => [kind, Decoration.mark({ class: `editor-is-${kind}` })]),
  );
  const draw = (view: EditorView): DecorationSet => {
    const builder = new RangeSetBuilder<Decoration>();
    let drawn = -1; // a long line can be in two visible ranges
    for (const range of view.visibleRanges) {
      for (let at = range.from; at <= range.to; ) {
        const line = view.state.doc.lineAt(at);
        if (line.from > drawn) {
          for (const { from, to, kind } of tokens(line.text, prepared)) {
            const mark = marks.get(kind);
            if (mark) builder.add(line.from + from, line.from + to, mark);
          }
          drawn = line.from;
        }
        at = line.to + 1;
      }
    }
    return builder.finish();
  };
  return ViewPlugin.fromClass(
    class {
      decorations: DecorationSet;
      constructor(view: EditorView) {
        this.decorations = draw(view);
      }
      update(update: ViewUpdate): void {
        if (update.docChanged || update.viewportChanged) this.decorations = draw(update.view);
      }
    },
    { decorations: (plugin) => plugin.decorations },
  );
}
