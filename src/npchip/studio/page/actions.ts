/** Requests of panels. `shell/` carries them out; panels import nothing of the shell. */

import type { Cell, Project, Quantity, Travel } from "./protocol";

export interface Actions {
  /** The text of a file changed. */
  edit(file: string, text: string): void;
  /** Files were added, renamed or removed. */
  setProject(project: Project): void;
  show(file: string, line?: number): void;
  run(): void;
  pause(): void;
  reset(): void;
  go(travel: Travel, back?: boolean): void;
  /** Go to a line of the text, or back to it. Returns why there is no such way, or null. */
  goToLine(file: string, line: number, back: boolean): Promise<string | null>;
  toggleBreak(file: string, line: number): void;
  /** Give a line's breakpoint a condition, or none if it is empty. Returns why it cannot be read. */
  setBreakCondition(file: string, line: number, condition: string): Promise<string | null>;
  /** Stop where a condition holds. Returns why it cannot be read, or null. */
  addCondition(text: string): Promise<string | null>;
  removeCondition(text: string): void;
  /** Switch a breakpoint or condition on or off; `key` as in `disabled` of the store. */
  enableBreak(key: string, on: boolean): void;
  choose(row: number, column: number): void;
  showCell(cell: Cell): void;
  showFrame(index: number | null): void;
  whoWrote(value: Quantity): void;
  /** Cycles by address of a frame. */
  profile(frame: number): Promise<Float64Array>;
  check(): void;
  /** Offer bytes to the reader as a file to save. */
  save(name: string, data: BlobPart, type: string): void;
}

let carriedOutBy: Actions | null = null;

/** Say who carries the actions out. */
export function provide(actions: Actions): void {
  carriedOutBy = actions;
}

/** Return the actions; the shell has provided them before a panel is drawn. */
export function act(): Actions {
  if (!carriedOutBy) throw new Error("no actions were provided");
  return carriedOutBy;
}
