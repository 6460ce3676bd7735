/** The chip of a debug session, asked for in pictures. */

import type { DebugSession } from "vscode";
import type { ChipView, ProgramInfo } from "./array/messages";

/** Pixels of an NP in a row and in a column, and in all: a bank of its memory. */
const SIDE = 8;
const BANK = SIDE * SIDE;
const REGISTERS = 16;

/** The adapter's answer to `npchip/picture`: bytes, row by row. */
export interface Picture {
  rows: number;
  cols: number;
  data: Uint8Array;
}

async function picture(session: DebugSession, what: string): Promise<Picture> {
  const { rows, cols, data } = (await session.customRequest("npchip/picture", { what })) as {
    rows: number;
    cols: number;
    data: string;
  };
  return { rows, cols, data: new Uint8Array(Buffer.from(data, "base64")) };
}

/** Ask in the debugger's language, as in the debug console, and return the answer. */
export async function ask(session: DebugSession, expression: string): Promise<string> {
  const { result } = (await session.customRequest("evaluate", { expression, context: "repl" })) as { result: string };
  return result;
}

/** Choose the NP that the variables show. */
export async function choose(session: DebugSession, row: number, column: number): Promise<void> {
  await session.customRequest("npchip/choose", { row, column });
}

/** A counter of the debugger's language. */
async function counter(session: DebugSession, name: string): Promise<number> {
  const answer = await ask(session, `print ${name}`);
  const number = /(-?[\d,]+)\D*$/.exec(answer)?.[1];
  if (number === undefined) throw new Error(`${name} is no number: ${answer}`);
  return Number(number.replaceAll(",", ""));
}

/** Facts about the program for the array: the machine, names, and moves between NPs. */
export async function programOf(session: DebugSession): Promise<ProgramInfo> {
  return (await session.customRequest("npchip/program")) as ProgramInfo;
}

/** Look at the whole chip. */
export async function look(session: DebugSession, program: ProgramInfo): Promise<ChipView> {
  const banks = Math.ceil(program.machine.memory_bytes / BANK);
  const numbers = (count: number): number[] => [...Array(count).keys()];
  const pictures = (...names: string[]): Promise<Picture[]> =>
    Promise.all(names.map((name) => picture(session, name)));
  const counters = (...names: string[]): Promise<number[]> =>
    Promise.all(names.map((name) => counter(session, name)));

  const registers = await pictures(...numbers(REGISTERS).map((number) => `r${number}`));
  const [zero, carry, active] = await pictures("Z", "C", "active");
  const memory = await pictures(...numbers(banks).map((bank) => `bank ${bank * BANK}`));
  const [address, frame, frameCycles, cycles, instructions] = await counters(
    "pc", "frame", "frame_cycles", "cycles", "instructions",
  );
  if (!zero || !carry || !active) throw new Error("the debugger gives no flags");
  return {
    address: address ?? 0,
    stack: [],
    depth: 0,
    frame: frame ?? -1,
    frameCycles: frameCycles ?? 0,
    frameInstructions: 0,
    cycles: cycles ?? 0,
    instructions: instructions ?? 0,
    ended: false,
    status: null,
    error: null,
    registers: joined(registers.map(({ data }) => data)),
    zero: zero.data,
    carry: carry.data,
    active: active.data,
    masks: [],
    memory: joined(memory.map(planesOf)).subarray(0, program.machine.memory_bytes * zero.data.length),
    exposed: (frame ?? -1) < 0 ? null : (await picture(session, "frame")).data,
  };
}

function joined(parts: Uint8Array[]): Uint8Array {
  return new Uint8Array(Buffer.concat(parts));
}

/** Take a picture of a bank apart into its 64 bytes of all NPs: `bankPicture` of the studio, turned round. */
export function planesOf({ rows, cols, data }: Picture): Uint8Array {
  const down = rows / SIDE;
  const across = cols / SIDE;
  const planes = new Uint8Array(data.length);
  for (let at = 0; at < data.length; at++) {
    const y = Math.floor(at / cols);
    const x = at % cols;
    const pixel = (y % SIDE) * SIDE + (x % SIDE);
    const np = Math.floor(y / SIDE) * across + Math.floor(x / SIDE);
    planes[pixel * down * across + np] = data[at] ?? 0;
  }
  return planes;
}
