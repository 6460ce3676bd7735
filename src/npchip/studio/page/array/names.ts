/** Names of values, addresses and calls. */

import type { Cell, ProgramInfo, Quantity } from "../protocol";
import type { Shown } from "./planes";

/** Return the program's names for a register, in the order of the source. */
export function namesOf(program: ProgramInfo | null, register: number): string[] {
  const named = Object.entries(program?.registers ?? {});
  return named.filter(([, number]) => number === register).map(([name]) => name);
}

/** Return a register by number and names, such as `r3 sum`. */
export function registerText(program: ProgramInfo | null, register: number): string {
  return [`r${register}`, ...namesOf(program, register)].join(" ");
}

/** Return a cell in the debugger's language. */
export function cellText(cell: Cell): string {
  if (cell.kind === "register") return `r${cell.index}`;
  if (cell.kind === "memory") return `mem[${cell.index}]`;
  return cell.kind === "flag" ? String(cell.index) : "active";
}

/** Return a quantity in the debugger's language, such as `np(2,3).r4`. */
export function quantityText(value: Quantity): string {
  switch (value.kind) {
    case "cell":
      return cellText(value.cell);
    case "one":
      return `np(${value.row},${value.column}).${cellText(value.cell)}`;
    case "pixel":
      return `pixel(${value.row},${value.column})`;
    case "counter":
      return value.name;
  }
}

/** Return what the array shows, for a heading. */
export function shownText(program: ProgramInfo | null, shown: Shown): string {
  if (shown.kind === "frame") return "exposed frame";
  if (shown.kind === "bank") return `memory bank ${shown.first}`;
  const { cell } = shown;
  if (cell.kind === "register") return registerText(program, Number(cell.index));
  return cell.kind === "memory" ? `memory byte ${cell.index}` : cellText(cell);
}

/** Return an address by the label before it, such as `scan + 3`; by number if there is none. */
export function addressText(program: ProgramInfo, address: number): string {
  let best: [string, number] | null = null;
  for (const [name, at] of Object.entries(program.labels)) {
    if (at <= address && (!best || at > best[1])) best = [name, at];
  }
  if (!best) return `address ${address}`;
  return best[1] === address ? best[0] : `${best[0]} + ${address - best[1]}`;
}

/** An open call: the routine's name, and the address and line that called it. */
export interface OpenCall {
  routine: string;
  caller: number;
  at: { file: string; line: number } | null;
}

/** Return the open calls, the newest first; `stack` holds return addresses, the newest last. */
export function openCalls(program: ProgramInfo, stack: number[]): OpenCall[] {
  return stack.toReversed().map((back) => {
    const caller = back - 1;
    const word = program.words[caller];
    return {
      routine: called(program, word?.text ?? "") ?? `called from ${addressText(program, caller)}`,
      caller,
      at: word?.origins[0] ?? null,
    };
  });
}

/** The routine that an instruction names: its last operand, a label or an address. */
function called(program: ProgramInfo, text: string): string | null {
  const operand = text.split(/[\s,]+/).at(-1) ?? "";
  if (operand in program.labels) return operand;
  const address = /^(0x[\da-f]+|\d+)$/i.test(operand) ? Number(operand) : null;
  if (address === null) return null;
  const label = Object.entries(program.labels).find(([, at]) => at === address);
  return label?.[0] ?? `address ${address}`;
}
