/** PGM, PPM and PBM, which browsers do not read. Several pictures may stand one behind another. */

import { text } from "./bytes";
import { checkPixels, damaged, FramesError, notHere, tooDeep } from "./errors";
import { luma, type Picture } from "./luma";
import type { Pictures } from "./pictures";

const BLANKS = " \t\n\v\f\r";
const LONGEST_NUMBER = 10;
/** Bytes that a header may take with its comments, as in npchip. */
const HEAD = 1 << 16;

interface Header {
  /** 1 to 6, as behind the P. */
  kind: number;
  rows: number;
  cols: number;
  channels: number;
  largest: number;
  /** Place of the first pixel. */
  start: number;
}

/** Read the pictures of a PGM, PPM or PBM; as text it holds only one. */
export function pnmPictures(data: Uint8Array<ArrayBuffer>, name: string): Pictures {
  const parts: { head: Header; end: number }[] = [];
  let damage: FramesError | null = null;
  let start = 0;
  while (start < data.length && !damage) {
    if (parts.length && data.subarray(start, start + HEAD).every(isBlank)) break;
    const where = `${name}, frame ${parts.length}`;
    try {
      const head = readHeader(data, start, where);
      if (head.kind < 4) {
        checkText(data, start, head, name);
        parts.push({ head, end: data.length });
        break;
      }
      start = head.start + lineBytes(head) * head.rows;
      parts.push({ head, end: Math.min(start, data.length) });
    } catch (error) {
      if (!(error instanceof FramesError)) throw error;
      damage = error;
    }
  }
  async function* each(): AsyncGenerator<Picture> {
    for (const [index, { head, end }] of parts.entries()) {
      const where = parts.length > 1 ? `${name}, frame ${index}` : name;
      yield toPicture(head, head.kind < 4 ? asText(data, head, where) : raw(data, head, end, where));
    }
    if (damage) throw damage;
  }
  return { count: parts.length + (damage ? 1 : 0), each: each() };
}

function isBlank(byte: number): boolean {
  return byte < 128 && BLANKS.includes(String.fromCharCode(byte));
}

function readHeader(data: Uint8Array, start: number, name: string): Header {
  const kind = Number(text(data.subarray(start + 1, start + 2)));
  if (data[start] !== 0x50 || !(kind >= 1 && kind <= 6) || !isBlank(data[start + 2] ?? 0)) {
    const next = text(data.subarray(start + 1, start + 2));
    if (data[start] === 0x50 && "fF0y".includes(next || " ")) {
      throw notHere(name, `a portable picture of kind P${next}`, "Save it as PGM or PPM of 8 bits");
    }
    throw damaged(name, "not one of PGM, PPM, PBM");
  }
  let at = start + 3;
  const number = (): number => {
    let token = "";
    for (; token.length <= LONGEST_NUMBER; at++) {
      if (at >= data.length || at > start + HEAD) break;
      if (data[at] === 0x23) {
        while (at < data.length && data[at] !== 10 && data[at] !== 13) at++;
      } else if (!isBlank(data[at]!)) token += String.fromCharCode(data[at]!);
      else if (token) break;
    }
    at++;
    if (!/^\+?[0-9]+$/.test(token)) throw damaged(name, `its header has no number in '${token}'`);
    return Number(token);
  };
  const [cols, rows] = [number(), number()];
  const largest = kind % 3 === 1 ? 1 : number();
  checkPixels({ rows, cols }, name);
  if (largest < 1 || largest > 65535) throw damaged(name, "its largest value is not in 1-65535");
  if (largest > 255) throw tooDeep(name, "more");
  return { kind, rows, cols, channels: kind % 3 === 0 ? 3 : 1, largest, start: at };
}

function lineBytes(head: Header): number {
  return head.kind === 4 ? Math.ceil(head.cols / 8) : head.cols * head.channels;
}

/** Return the samples of a picture in bytes, scaled to 0-255. */
function raw(data: Uint8Array, head: Header, end: number, name: string): Uint8Array {
  const width = lineBytes(head);
  if (end - head.start < width * head.rows) throw damaged(name, "its pixels are cut short");
  const bytes = data.subarray(head.start, end);
  if (head.kind !== 4) return bytes.map(scaling(head.largest));
  const out = new Uint8Array(head.rows * head.cols);
  for (let at = 0; at < out.length; at++) {
    const [row, col] = [Math.floor(at / head.cols), at % head.cols];
    out[at] = (bytes[row * width + (col >> 3)]! >> (7 - (col & 7))) & 1 ? 0 : 255;
  }
  return out;
}

function checkText(data: Uint8Array, start: number, head: Header, name: string): void {
  const most = 16 * head.cols * head.rows * head.channels + HEAD;
  if (data.length - start > most) throw damaged(name, "it holds more text than its pixels need");
  const rest = new TextDecoder("latin1").decode(data.subarray(start + 2));
  if (/[^0-9 \t\n\v\f\r]/.test(rest.replace(/#[^\r\n]*/g, ""))) {
    throw damaged(name, "other things stand among its numbers");
  }
}

/** Return the samples of a picture in text, scaled to 0-255. */
function asText(data: Uint8Array, head: Header, name: string): Uint8Array {
  const count = head.rows * head.cols * head.channels;
  const rest = new TextDecoder("latin1")
    .decode(data.subarray(head.start))
    .replace(/#[^\r\n]*(?:[\r\n]|$)/g, "");
  const out = new Uint8Array(count);
  let at = 0;
  if (head.kind === 1) {
    for (const digit of rest.replace(/\s/g, "")) {
      if (digit !== "0" && digit !== "1") throw damaged(name, `it holds '${digit}', not 0 and 1`);
      if (at < count) out[at++] = digit === "1" ? 0 : 255;
    }
  } else {
    const scale = scaling(head.largest);
    for (const [token] of rest.matchAll(/[0-9]+/g)) {
      if (at === count) break;
      if (token.length > LONGEST_NUMBER || Number(token) > head.largest) {
        throw damaged(name, `its value ${token} is larger than ${head.largest}`);
      }
      out[at++] = scale(Number(token));
    }
  }
  if (at < count) throw damaged(name, "its pixels are cut short");
  return out;
}

/** Return what scales a value to 0-255, with halves rounded to even as Pillow does. */
function scaling(largest: number): (value: number) => number {
  const table = Uint8Array.from({ length: 256 }, (_, value) => {
    const scaled = (value / largest) * 255;
    const below = Math.floor(scaled);
    const up = scaled - below === 0.5 ? below % 2 === 1 : scaled - below > 0.5;
    return Math.min(255, below + (up ? 1 : 0));
  });
  return (value) => table[value]!;
}

function toPicture(head: Header, values: Uint8Array): Picture {
  const { rows, cols, channels } = head;
  const data = new Uint8Array(rows * cols);
  for (let at = 0; at < data.length; at++) {
    const from = at * channels;
    data[at] =
      channels === 1 ? values[at]! : luma(values[from]!, values[from + 1]!, values[from + 2]!);
  }
  return { rows, cols, data };
}
