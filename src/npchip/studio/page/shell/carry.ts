/** Carries out what panels ask for. */

import type { Actions } from "../actions";
import type { Quantity, Travel } from "../protocol";
import { breaks, chosen, conditions, disabled, openFile, program, running, shownCell, shownFrame, wantedLine } from "../store";
import { go, pause, reset, setBreaks } from "./chip";
import { check } from "./checks";
import { start } from "./clips";
import { informed } from "./compile";
import { chip } from "./parts";
import { edit, setProject } from "./project";
import { during, say, sayError, textOf } from "./say";

export const actions: Actions = {
  edit,
  setProject,
  show(file, line) {
    openFile.value = file;
    if (line !== undefined) wantedLine.value = { file, line };
  },
  run() {
    if (!running.value) void start().catch(sayError);
  },
  pause,
  reset: () => void reset(),
  go: (travel: Travel, back = false) => void go(travel, back),
  toggleBreak(file, line) {
    const others = breaks.value.filter((each) => each.file !== file || each.line !== line);
    const there = others.length < breaks.value.length;
    breaks.value = there ? others : [...others, { file, line, condition: "" }];
  },
  async setBreakCondition(file, line, condition) {
    const wrong = condition.trim() ? await mistakeIn(condition) : null;
    if (wrong !== null) return wrong;
    const others = breaks.value.filter((each) => each.file !== file || each.line !== line);
    breaks.value = [...others, { file, line, condition: condition.trim() }];
    return null;
  },
  async addCondition(text) {
    const wrong = await mistakeIn(text);
    if (wrong !== null) return wrong;
    conditions.value = [...conditions.value.filter((each) => each !== text), text];
    return null;
  },
  removeCondition(text) {
    conditions.value = conditions.value.filter((each) => each !== text);
  },
  enableBreak(key, on) {
    const keys = new Set(disabled.value);
    if (on) keys.delete(key);
    else keys.add(key);
    disabled.value = keys;
  },
  choose(row, column) {
    chosen.value = { row, column };
  },
  showCell(cell) {
    shownCell.value = cell;
  },
  showFrame(index) {
    shownFrame.value = index;
  },
  whoWrote: (value: Quantity) => void whoWrote(value),
  profile: (frame) => chip().profile(frame),
  check: () => void check(),
  save(name, data, type) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([data], { type }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
    say(`Saved ${name}`);
  },
};

/** Return what is wrong with a condition; null if it can be read. */
async function mistakeIn(text: string): Promise<string | null> {
  try {
    await (await informed()).condition(text);
    return null;
  } catch (fault) {
    return textOf(fault);
  }
}

/** Find the last write to a value, say it, and show its line. */
async function whoWrote(value: Quantity): Promise<void> {
  await during("Looking for the last write", async () => {
    const found = await chip().wrote(value, await (await informed()).writers(value));
    if (!found) {
      say("Nothing has written it since the reset");
      return;
    }
    const word = program.value?.words[found.address];
    const origin = word?.origins[0];
    if (origin) actions.show(origin.file, origin.line);
    const where = origin ? `${origin.file}, line ${origin.line}` : `address ${found.address}`;
    const frame = found.frame < 0 ? "the setup" : `frame ${found.frame}`;
    say(`${where} wrote it in ${frame}: ${word?.text ?? ""} (${found.before} → ${found.after})`);
  });
}

/** Hand breakpoints and conditions to the chip whenever they change. */
export function breaksFollow(): () => void {
  let first = true;
  const follow = (): void => {
    if (first) return;
    void setBreaks();
  };
  const stops = [breaks.subscribe(follow), conditions.subscribe(follow), disabled.subscribe(follow)];
  first = false;
  return () => {
    for (const end of stops) end();
  };
}
