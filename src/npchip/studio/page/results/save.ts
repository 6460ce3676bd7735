/** A run as CSV and as the JSON of `npchip run --json` (docs/json.md, schema 1). */

import type {
  ChipView,
  FrameBatch,
  FrameDocument,
  ProgramInfo,
  RunDocument,
  Value,
} from "../protocol";
import { SETUP, type Column, type Sent, columnsOf, isImage, sentAt, sentIn, setupOf } from "./frames";

const CLOCK_HZ = 10_000_000; // illustrative: decision, not silicon

/** Return the run as CSV (RFC 4180): a line a frame, lists joined by blanks, no planes. */
export function toCsv(program: ProgramInfo | null, batches: readonly FrameBatch[]): string {
  const columns = columnsOf(program, batches).filter((column) => !isImage(column));
  const lines = [["frame", ...columns.map((column) => column.name), "cycles"]];
  const setup = setupOf(batches);
  if (setup) {
    const values = columns.map(({ name }) => cell(sentIn(batches, name, SETUP)));
    lines.push(["setup", ...values, String(setup.cycles)]);
  }
  for (const batch of batches) {
    for (let at = 0; at < batch.cycles.length; at++) {
      const values = columns.map(({ name }) => cell(sentAt(batch, name, at)));
      lines.push([String(batch.first + at), ...values, String(batch.cycles[at])]);
    }
  }
  return lines.map((line) => `${line.map(quoted).join(",")}\r\n`).join("");
}

function cell(value: Sent): string {
  if (value === null || value === undefined) return "";
  return typeof value === "number" ? String(value) : value.join(" ");
}

function quoted(text: string): string {
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

/**
 * Return the run as JSON, in parts that follow one another, as it may be long.
 *
 * `status` is null as long as the run can go on, `setup` is null if it is not known. Planes that
 * are no longer kept are left out.
 */
export function toJson(
  program: ProgramInfo,
  batches: readonly FrameBatch[],
  view: ChipView | null,
): string[] {
  const over = view?.ended ? view : null;
  const setup = setupOf(batches);
  const head: [string, unknown][] = [
    ["schema", 1],
    ["program", program.name],
    ["engine", "wasm"],
    ["machine", program.machine.name],
    ["status", over?.status ?? null],
  ];
  if (over?.error) head.push(["error", blamed(over.error, program)]);
  const sums = total(batches, setup);
  const columns = columnsOf(program, batches);
  head.push(
    ["instructions", over?.instructions ?? sums.instructions],
    ["cycles", over?.cycles ?? sums.cycles],
    ["clock_hz", CLOCK_HZ],
    ["setup", setup ? { cycles: setup.cycles, outputs: setup.outputs } : null],
  );
  const lines = head.map(([key, value]) => ` ${spaced(key)}: ${spaced(value)},\n`);
  const rows = [...frameRows(batches, columns)];
  if (!rows.length) return ["{\n", ...lines, ' "frames": []\n}\n'];
  return ["{\n", ...lines, ' "frames": [\n  ', rows.shift() ?? "", ...rows.map(after), "\n ]\n}\n"];
}

function after(row: string): string {
  return `,\n  ${row}`;
}

function* frameRows(batches: readonly FrameBatch[], columns: Column[]): Generator<string> {
  for (const batch of batches) {
    for (let at = 0; at < batch.cycles.length; at++) {
      const outputs: Record<string, Value> = {};
      for (const { name } of columns) {
        const sent = sentAt(batch, name, at);
        if (sent !== undefined) outputs[name] = nested(sent, batch, name);
      }
      yield spaced({ index: batch.first + at, cycles: batch.cycles[at], outputs });
    }
  }
}

/** Return a value in plain form: planes and pictures as a list of rows. */
function nested(sent: Exclude<Sent, undefined>, batch: FrameBatch, name: string): Value {
  if (!(sent instanceof Uint8Array)) return sent;
  const column = batch.outputs[name];
  const cols = column && "cols" in column ? column.cols : sent.length;
  const rows: number[][] = [];
  for (let at = 0; at < sent.length; at += cols) rows.push([...sent.subarray(at, at + cols)]);
  return rows;
}

function blamed(error: NonNullable<RunDocument["error"]>, program: ProgramInfo) {
  const origin = program.words[error.address]?.origins[0];
  const { code, message, address } = error;
  return { code, message, address, file: origin?.file ?? null, line: origin?.line ?? null };
}

function total(batches: readonly FrameBatch[], setup: FrameDocument | undefined) {
  let { cycles, instructions } = setup ?? { cycles: 0, instructions: 0 };
  for (const batch of batches) {
    for (const count of batch.cycles) cycles += count;
    for (const count of batch.instructions) instructions += count;
  }
  return { cycles, instructions };
}

/** Return a value on one line, as Python's `json` writes it: only ASCII, blanks after `,` and `:`. */
function spaced(value: unknown): string {
  if (typeof value === "string") {
    const escaped = (c: string): string => `\\u${c.charCodeAt(0).toString(16).padStart(4, "0")}`;
    return JSON.stringify(value).replace(/[\u007f-\uffff]/g, escaped);
  }
  if (Array.isArray(value)) return `[${value.map(spaced).join(", ")}]`;
  if (typeof value === "object" && value !== null) {
    const members = Object.entries(value).map(([key, one]) => `${spaced(key)}: ${spaced(one)}`);
    return `{${members.join(", ")}}`;
  }
  return JSON.stringify(value);
}
