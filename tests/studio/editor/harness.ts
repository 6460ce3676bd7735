/** Answers questions with the editor's own code. */

import { history, undo } from "@codemirror/commands";
import { EditorState, type TransactionSpec } from "@codemirror/state";
import { prepare, tokens } from "../../../src/npchip/studio/page/editor/colours";
import { cardAt } from "../../../src/npchip/studio/page/editor/cards";
import { offers, template } from "../../../src/npchip/studio/page/editor/completion";
import { range } from "../../../src/npchip/studio/page/editor/faults";
import { nameFault, renamed, tabNames } from "../../../src/npchip/studio/page/editor/files";
import { targetAt } from "../../../src/npchip/studio/page/editor/jumps";
import { indentation, spot } from "../../../src/npchip/studio/page/editor/lines";
import {
  breakLines,
  breakpoints,
  lineNow,
  marks,
  setBreaks,
  setSums,
} from "../../../src/npchip/studio/page/editor/marks";
import { allNames, repetitions } from "../../../src/npchip/studio/page/editor/names";
import { cyclesText, lineSums, linesAt, wordsText } from "../../../src/npchip/studio/page/editor/sums";
import { answering } from "../../support/answering";

/** What a test asks; its parts are those of the question. */
type Question = any;

const ASKS: Record<string, (question: Question) => unknown> = {
  colours: ({ rules, text }) => {
    const prepared = prepare(rules);
    const line = (text: string): [string, string][] =>
      tokens(text, prepared).map(({ from, to, kind }) => [text.slice(from, to), kind]);
    return text.split("\n").flatMap(line);
  },
  names: ({ project }) => allNames(project, []),
  offers: ({ line, entries, project }) => offers(spot(line, line.length), entries, allNames(project, [])),
  /** Words of the sources that are not offered where they stand. */
  unoffered: ({ entries, project, words }) => {
    const names = allNames(project, []);
    return words.filter(([line, to, word]: [string, number, string]) => {
      const labels = offers(spot(line, to), entries, names).map(({ label }) => label.toLowerCase());
      return !labels.includes(word.toLowerCase());
    });
  },
  template: ({ offer, column }) => template(offer, column),
  sums: ({ words, project }) =>
    Object.fromEntries(
      Object.keys(project.files).map((file) => [file, [...lineSums(words, file, repetitions(project)).values()]]),
    ),
  linesAt: ({ words, address, file }) => linesAt(words, address, file),
  texts: ({ program }) => [wordsText(program), cyclesText(program)],
  indentation: ({ pairs }) => pairs.map(([above, line]: [string, string]) => indentation(above, line)),
  renamed: ({ project, from, to }) => renamed(project, from, to),
  tabs: ({ project, open }) => tabNames(project, open),
  nameFault: ({ name, taken }) => nameFault(name, taken),
  card: ({ line, offset, entries, project, program }) => {
    const names = allNames(project, program?.definitions ?? []);
    return cardAt(line, 1, offset, { entries, names, program, file: project.main });
  },
  target: ({ text, pos, project }) => {
    const doc = EditorState.create({ doc: text }).doc;
    return targetAt(doc, pos, project.main, allNames(project, []), Object.keys(project.files));
  },
  range: ({ text, place }) => range(EditorState.create({ doc: text }).doc, place),
  /** Where breakpoints and program lines are after each change; `null` undoes the last one. */
  edits: ({ text, breaks, lines, changes }) => {
    let state = EditorState.create({ doc: text, extensions: [history(), marks] });
    const apply = (spec: TransactionSpec): void => {
      state = state.update(spec).state;
    };
    const sums = lines.map((line: number) => [line, { line, words: 1, least: 1, most: 1, copies: 1 }]);
    const stops = breaks.map(([line, condition]: [number, string]) => [line, { condition, off: line === 3 }]);
    apply({ effects: [setBreaks.of(new Map(stops)), setSums.of(new Map(sums))] });
    return changes.map((change: TransactionSpec["changes"] | null) => {
      if (change) apply({ changes: change });
      else undo({ state, dispatch: (transaction) => (state = transaction.state) });
      return {
        breaks: [...breakLines(state)].map(([line, { condition, off }]) => [line, condition, off]),
        marked: state.field(breakpoints).size,
        lines: lines.map((line: number) => lineNow(state, line)),
      };
    });
  },
};

await answering(({ ask, many }: { ask: string; many: Question[] }) => {
  const answer = ASKS[ask] as (question: Question) => unknown;
  return many.map(answer);
});
