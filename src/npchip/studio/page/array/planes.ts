/** Planes and pictures of the chip's state, in the layout of `npchip.machine.layout`. */

import type { Cell, ChipView } from "../protocol";

/** Pixels of an NP in a row and in a column, and in all: a bank of its memory. */
export const SIDE = 8;
export const BANK = SIDE * SIDE;

/** The contents of the array: a value of every NP, or 64 pixels of each. */
export type Shown =
  | { kind: "cell"; cell: Cell }
  | { kind: "bank"; first: number }
  | { kind: "frame" };

/** Return a cell's value in every NP, row by row; flags and the activity as 0 and 1. */
export function planeOf(view: ChipView, cell: Cell): Uint8Array {
  const count = view.zero.length;
  switch (cell.kind) {
    case "register":
      return slice(view.registers, Number(cell.index), count);
    case "memory":
      return slice(view.memory, Number(cell.index), count);
    case "flag":
      return bits(cell.index === "Z" ? view.zero : view.carry);
    case "active":
      return bits(view.active);
  }
}

function slice(planes: Uint8Array, index: number, count: number): Uint8Array {
  return planes.subarray(index * count, (index + 1) * count);
}

function bits(plane: Uint8Array): Uint8Array {
  return plane.map((value) => (value ? 1 : 0));
}

/** Return the picture of a bank in all NPs, row by row: byte 8·y + x of the bank is pixel (y, x). */
export function bankPicture(memory: Uint8Array, first: number, rows: number, cols: number): Uint8Array {
  const count = rows * cols;
  const width = cols * SIDE;
  const picture = new Uint8Array(count * BANK);
  for (let pixel = 0; pixel < BANK; pixel++) {
    const plane = (first + pixel) * count;
    const corner = Math.floor(pixel / SIDE) * width + (pixel % SIDE);
    for (let row = 0; row < rows; row++) {
      const from = plane + row * cols;
      const to = corner + row * SIDE * width;
      for (let column = 0; column < cols; column++) {
        picture[to + column * SIDE] = memory[from + column] ?? 0;
      }
    }
  }
  return picture;
}

/** Return up to 64 bytes of an NP's memory. */
export function bankOf(view: ChipView, first: number, at: number): Uint8Array {
  const count = view.zero.length;
  const length = Math.min(BANK, Math.floor(view.memory.length / count) - first);
  return Uint8Array.from({ length }, (_, byte) => view.memory[(first + byte) * count + at] ?? 0);
}

/** Return the 64 pixels of an NP in a picture, row by row. */
export function pixelsOf(picture: Uint8Array, row: number, column: number, cols: number): Uint8Array {
  const width = cols * SIDE;
  const corner = row * SIDE * width + column * SIDE;
  return Uint8Array.from(
    { length: BANK },
    (_, pixel) => picture[corner + Math.floor(pixel / SIDE) * width + (pixel % SIDE)] ?? 0,
  );
}

/** Return the picture that the array shows, or null if it shows a value of each NP. */
export function pictureOf(view: ChipView, shown: Shown, rows: number, cols: number): Uint8Array | null {
  if (shown.kind === "cell") return null;
  if (shown.kind === "bank") return bankPicture(view.memory, shown.first, rows, cols);
  return view.exposed ?? new Uint8Array(rows * cols * BANK);
}

/** Return whether each value differs from an earlier one; all false if nothing can be compared. */
export function changes(now: Uint8Array, before: Uint8Array | null): boolean[] {
  const alike = before?.length === now.length ? before : null;
  return Array.from(now, (value, at) => alike !== null && value !== alike[at]);
}

/** Return whether any of an NP's 64 pixels differs, for each NP. */
export function pictureChanges(
  now: Uint8Array,
  before: Uint8Array | null,
  rows: number,
  cols: number,
): boolean[] {
  const found = new Array<boolean>(rows * cols).fill(false);
  if (before?.length !== now.length) return found;
  const width = cols * SIDE;
  for (let at = 0; at < now.length; at++) {
    if (now[at] !== before[at]) {
      found[Math.floor(at / width / SIDE) * cols + Math.floor((at % width) / SIDE)] = true;
    }
  }
  return found;
}
