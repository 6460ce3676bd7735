/** Carries out what panels ask for. */

import type { Actions } from "../actions";
import type { CompileRequest, Quantity, Travel } from "../protocol";
import { breaks, chosen, conditions, disabled, openFile, program, project, running, shownCell, shownFrame, wantedLine } from "../store";
import { during, type Job } from "../control/jobs";
import { offer } from "../control/save";
import { followSearch } from "../control/search";
import { heard, putAway, say, sayError, textOf } from "../say";
import { go, goToLine, origin, pause, reset, setBreaks } from "./chip";
import { check } from "./checks";
import { start } from "./clips";
import { compileNow, originOf } from "./compile";
import { chip, compiler } from "./parts";
import { lineIn } from "./places";
import { edit, setProject } from "./project";

export const actions: Actions = {
  edit,
  setProject,
  show(file, line) {
    openFile.value = file;
    if (line !== undefined) wantedLine.value = { file, line };
  },
  run() {
    putAway();
    if (!running.value) heard(start());
  },
  pause,
  reset() {
    putAway();
    heard(reset());
  },
  go(travel: Travel, back = false) {
    putAway();
    heard(go(travel, back));
  },
  goToLine(file, line, back) {
    putAway();
    return goToLine(file, line, back).catch((fault: unknown) => {
      sayError(fault);
      return null;
    });
  },
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
  whoWrote: (value: Quantity) => heard(whoWrote(value)),
  profile: (frame) => chip().profile(frame),
  check() {
    putAway();
    heard(check());
  },
  save(name, data, type) {
    offer(name, data, type);
    say(`Saved ${name}`);
  },
};

/** Return what is wrong with a condition; null if it can be read. */
async function mistakeIn(text: string): Promise<string | null> {
  try {
    // A text with mistakes has no names yet: those of the program in the chip count.
    const about = originOf((await compileNow())?.module ?? null) ?? origin();
    if (!about) return "The program has mistakes: mend them first";
    await compiler().condition(text, about);
    return null;
  } catch (fault) {
    return textOf(fault);
  }
}

/** Messages if no write was found. */
const NO_WRITE = {
  never: "Nothing has written it since the reset",
  "not kept": "Nothing has written it in the frames that are kept: what was before them cannot be run again",
  "given up": "The search for the last write was cancelled",
};

/** Show a line of the program in the chip where it is in the text now. */
function show(file: string, line: number, { project: made }: CompileRequest): void {
  const [old, now] = [made.files[file], project.value.files[file]];
  const moved = old === undefined || now === undefined ? line : lineIn(now, old, line);
  actions.show(file, moved ?? undefined);
}

/** Find the last write to a value, say it, and show its line. */
async function whoWrote(value: Quantity): Promise<void> {
  const work = async (job: Job): Promise<void> => {
    const about = origin();
    if (!about) throw new Error("No program is in the chip: press Reset first");
    const writers = await compiler().writers(value, about);
    const searched = followSearch((share) => job.tell(share));
    const found = await chip().wrote(value, writers).finally(searched);
    if (typeof found === "string") {
      say(NO_WRITE[found]);
      return;
    }
    const word = program.value?.words[found.address];
    const at = word?.origins[0];
    if (at) show(at.file, at.line, about);
    const where = at ? `${at.file}, line ${at.line}` : `address ${found.address}`;
    const frame = found.frame < 0 ? "the setup" : `frame ${found.frame}`;
    say(`${where} wrote it in ${frame}: ${word?.text ?? ""} (${found.before} → ${found.after})`);
  };
  await during("Looking for the last write", work, () => chip().pause());
}

/** Hand breakpoints and conditions to the chip whenever they change. */
export function breaksFollow(): () => void {
  let first = true;
  const follow = (): void => {
    if (first) return;
    heard(setBreaks());
  };
  const stops = [breaks.subscribe(follow), conditions.subscribe(follow), disabled.subscribe(follow)];
  first = false;
  return () => {
    for (const end of stops) end();
  };
}
