/** The panel where the program is written. */

import { batch, computed, effect, signal } from "@preact/signals";
import { EditorView } from "@codemirror/view";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { act } from "../actions";
import type { Place } from "../protocol";
import {
  breakKey,
  breaks,
  compiled,
  cursor,
  diagnostics,
  disabled,
  language,
  library,
  openFile,
  program,
  project,
  running,
  stop,
  view as chipView,
  wantedLine,
} from "../store";
import { askCondition } from "./condition";
import { faultsOf, faultText, range } from "./faults";
import { tabNames, textOf } from "./files";
import { lineText } from "./gutters";
import { targetAt, Trail } from "./jumps";
import type { LineStop } from "./marks";
import { Mistakes } from "./mistakes";
import { allNames, repetitions } from "./names";
import { Pane } from "./pane";
import { setup, type Wishes } from "./setup";
import { Strip } from "./strip";
import { PANEL, Tabs } from "./tabs";

const HELP = "editor-help";

const names = computed(() => allNames(project.value, (compiled.value?.program ?? program.value)?.definitions ?? []));
const files = computed(() => [...new Set([...Object.keys(project.value.files), ...Object.keys(library.value)])]);
const cursorLine = signal("");

/** The editor: tabs, text, strip, mistakes. */
export function Editor(): JSX.Element {
  const parent = useRef<HTMLDivElement>(null);
  const pane = useRef<Pane | null>(null);
  const trail = useRef(new Trail());

  const go = (place: Place): void => {
    leave(pane.current, trail.current);
    act().show(place.file);
    pane.current?.go(place.line, place.column);
    pane.current?.view.focus();
  };

  useEffect(() => {
    if (!parent.current) return undefined;
    const made = new Pane(parent.current, setup(wishes(pane, trail.current, go), HELP), {
      edited: (file, text) => act().edit(file, text),
      moved: moveBreaks,
      looked(state) {
        const { from, number } = state.doc.lineAt(state.selection.main.head);
        cursorLine.value = lineText(state, from);
        const { file } = made;
        const at = cursor.peek();
        if (at?.file !== file || at.line !== number) cursor.value = { file, line: number };
      },
    });
    pane.current = made;
    const ends = follow(made);
    return () => {
      for (const end of ends) end();
      made.destroy();
      pane.current = null;
    };
  }, []);

  return (
    <div class="editor">
      <Tabs onRenamed={(from, to) => pane.current?.renamed(from, to)} />
      <div class="editor-text" id={PANEL} role="tabpanel" aria-label={openFile.value} ref={parent} />
      <p id={HELP} class="editor-hidden">
        Tab goes to the next column; press Escape, then Tab, to leave the editor. F1 explains the word at the cursor,
        F8 goes to the next mistake, F9 sets a breakpoint. Cycles and marks of the current line are repeated below the editor.
      </p>
      <Strip line={cursorLine} />
      <Mistakes onGo={go} />
    </div>
  );
}

/** Keep the pane as the store is. Return what ends that. */
function follow(pane: Pane): (() => void)[] {
  let shown = "";
  return [
    effect(() => {
      const { text, own } = textOf(openFile.value, project.value, library.value);
      pane.open(openFile.value, text, own);
    }),
    effect(() => {
      const all = new Set(files.value);
      pane.keepOnly((file) => all.has(file));
    }),
    effect(() => pane.colour(language.value?.colours ?? [])),
    effect(() => pane.underline(faultsOf(diagnostics.value, openFile.value, project.peek().main))),
    effect(() => {
      openFile.value;
      // Not when the text changes: the lines are those of the program until there is a new one.
      pane.sum(compiled.value?.program ?? program.value, repetitions(project.peek()));
    }),
    effect(() => {
      openFile.value;
      pane.break(breaks.value, disabled.value);
    }),
    effect(() => {
      // After the sums, which tell where the lines of the program are now.
      compiled.value;
      openFile.value;
      pane.mark(program.value, chipView.value?.address ?? null);
    }),
    effect(() => {
      // Bring the line into view where the chip came to rest, but not at the end of a run.
      const now = chipView.value;
      if (running.value || !now || !stop.value || stop.value.reason === "ended") return;
      const rest = `${now.address} ${now.instructions}`;
      if (rest !== shown) bringIntoView(pane, now.address);
      shown = rest;
    }),
    effect(() => {
      const wanted = wantedLine.value;
      if (wanted && wanted.file === openFile.peek()) pane.go(wanted.line);
    }),
  ];
}

function bringIntoView(pane: Pane, address: number): void {
  const { here, uses } = pane.linesOf(program.peek(), address);
  const line = here ?? uses[0];
  const first = program.peek()?.words[address]?.origins[0];
  if (line !== undefined) pane.reveal(line);
  else if (first && files.peek().includes(first.file)) {
    act().show(first.file);
    pane.reveal(pane.linesOf(program.peek(), address).here ?? first.line);
  }
}

/** Breakpoints of a file have moved with its lines, with whether they are switched off. */
function moveBreaks(file: string, stops: ReadonlyMap<number, LineStop>): void {
  batch(() => {
    const before = breaks.peek().filter((each) => each.file === file);
    for (const { line } of before) act().enableBreak(breakKey(file, line), true);
    const others = breaks.peek().filter((each) => each.file !== file);
    breaks.value = [...others, ...[...stops].map(([line, { condition }]) => ({ file, line, condition }))];
    for (const [line, { off }] of stops) if (off) act().enableBreak(breakKey(file, line), false);
  });
}

function leave(pane: Pane | null, trail: Trail): void {
  if (pane) trail.leave(pane.file, pane.view.state.selection.main.head);
}

function wishes(pane: { current: Pane | null }, trail: Trail, go: (place: Place) => void): Wishes {
  const say = (view: EditorView, text: string): boolean => {
    view.dispatch({ effects: EditorView.announce.of(text) });
    return true;
  };
  return {
    known: () => ({
      entries: language.peek()?.entries ?? [],
      names: names.peek(),
      program: program.peek(),
      file: openFile.peek(),
      files: files.peek(),
    }),
    toggleBreak(view, line) {
      const file = openFile.peek();
      const there = breaks.peek().some((each) => each.file === file && each.line === line);
      act().toggleBreak(file, line);
      say(view, `${there ? "No breakpoint" : "Breakpoint"} on line ${line}`);
    },
    askBreak(view, line) {
      const file = openFile.peek();
      const isIt = (each: { file: string; line: number }): boolean => each.file === file && each.line === line;
      askCondition(view, line, breaks.peek().find(isIt)?.condition ?? "", {
        set: (condition) => act().setBreakCondition(file, line, condition),
        remove() {
          if (breaks.peek().some(isIt)) act().toggleBreak(file, line);
        },
      });
    },
    nextFault: (view, step) => nextFault(pane.current, view, step, say),
    define(view, pos) {
      const target = targetAt(view.state.doc, pos, openFile.peek(), names.peek(), files.peek());
      if (!target) return say(view, "Nothing here is defined in a file of the program");
      go({ ...target, length: 0 });
      return true;
    },
    back(view) {
      const place = trail.back((file) => files.peek().includes(file));
      if (!place) return say(view, "No place to go back to");
      act().show(place.file);
      pane.current?.at(place.pos);
      return true;
    },
  };
}

/** Go to the next mistake of the file, then to those of the next file that has some. */
function nextFault(
  pane: Pane | null,
  view: EditorView,
  step: 1 | -1,
  say: (view: EditorView, text: string) => boolean,
): boolean {
  const { main } = project.peek();
  const tabs = tabNames(project.peek(), openFile.peek());
  const start = tabs.indexOf(openFile.peek());
  const { head } = view.state.selection.main;
  for (let turn = 0; turn <= tabs.length; turn++) {
    const file = tabs[(start + turn * step + tabs.length * tabs.length) % tabs.length] as string;
    const faults = faultsOf(diagnostics.peek(), file, main).filter(({ place }) => place);
    if (step < 0) faults.reverse();
    const fault = faults.find(({ place }) => {
      if (!place || turn > 0) return true;
      const { from } = range(view.state.doc, place);
      return step > 0 ? from > head : from < head;
    });
    if (!fault?.place) continue;
    act().show(file);
    pane?.go(fault.place.line, fault.place.column);
    return say(view, `${file}, line ${fault.place.line}. ${faultText(fault)}`);
  }
  return say(view, "No mistakes");
}
