/** `.npy` files: the header, checked against the file's size before memory is taken. */

import { text } from "./bytes";
import { damaged, FramesError } from "./errors";

/** The header of a `.npy` file. */
export interface NpyHeader {
  shape: number[];
  fortran: boolean;
  /** Letter of NumPy's kind: u and i for integers, f, b, O and others. */
  kind: string;
  bytes: number;
  little: boolean;
  /** The type as NumPy writes it, such as `float32`. */
  type: string;
  /** Place of the first value. */
  start: number;
}

/** Bytes to read for the header; NumPy refuses headers of more than 10,000 characters. */
export const HEAD = 1 << 16;
const LONGEST = 10000;

/** Return the error for Python objects, which are never read. */
export function objects(name: string): FramesError {
  return new FramesError(
    "NP221",
    `${name}: holds pickled Python objects, which could run code and are never loaded`,
    "Save a plain array: np.save(path, np.asarray(frames, dtype=np.uint8))",
  );
}

/** Read the header of a `.npy` file from its first bytes. */
export function readHeader(head: Uint8Array, name: string): NpyHeader {
  if (head[0] === 0x80) throw objects(name);
  const wrong = (reason: string): never => {
    throw damaged(name, reason);
  };
  if (head[0] !== 0x93 || text(head.subarray(1, 6)) !== "NUMPY" || head.length < 10) {
    wrong("it does not begin as a .npy file");
  }
  const [major, minor] = [head[6]!, head[7]!];
  if (major < 1 || major > 3 || minor !== 0) wrong(`a .npy file of version ${major}.${minor}`);
  const view = new DataView(head.buffer, head.byteOffset, head.length);
  const start = major === 1 ? 10 : 12;
  if (head.length < start) wrong("its header is cut short");
  const length = major === 1 ? view.getUint16(8, true) : view.getUint32(8, true);
  if (length > LONGEST) wrong(`its header of ${length} bytes is longer than NumPy reads`);
  if (head.length < start + length) wrong("its header is cut short");
  const bytes = head.subarray(start, start + length);
  const written = new TextDecoder(major === 3 ? "utf-8" : "latin1").decode(bytes);
  const { descr, fortran_order: fortran, shape } = dictionary(written, name);
  if (descr === undefined || fortran === undefined || shape === undefined) {
    wrong("its header lacks a part");
  }
  if (!/^(True|False)$/.test(fortran!)) wrong("its header does not tell the memory order");
  return {
    shape: numbers(shape!, name),
    fortran: fortran === "True",
    ...dtype(descr!, name),
    start: start + length,
  };
}

/** Split a Python dictionary into the sources of its values. */
function dictionary(source: string, name: string): Record<string, string> {
  const inside = /^\s*\{(.*)\}\s*$/s.exec(source)?.[1];
  if (inside === undefined) throw damaged(name, "its header is no dictionary");
  const found: Record<string, string> = {};
  const item = /\s*(['"])(\w+)\1\s*:\s*((?:\((?:[^()]*)\)|\[.*?\](?=\s*(?:,\s*['"]\w+['"]\s*:|,?\s*$))|'[^']*'|"[^"]*"|\w+))\s*(,|$)/gsy;
  let end = 0;
  for (let match = item.exec(inside); match; match = item.exec(inside)) {
    found[match[2]!] = match[3]!;
    end = item.lastIndex;
  }
  const known = Object.keys(found).every((key) => /^(descr|fortran_order|shape)$/.test(key));
  if (inside.slice(end).trim() !== "" || !known) {
    throw damaged(name, "its header cannot be understood");
  }
  return found;
}

function numbers(shape: string, name: string): number[] {
  const inside = /^\(((?:\s*\d+L?\s*(?:,|$))*\s*(?:\d+L?)?\s*)\)$/.exec(shape)?.[1];
  const single = inside !== undefined && /^\s*\d+L?\s*$/.test(inside); // (3) is no tuple
  if (inside === undefined || single) throw damaged(name, `its header says shape ${shape}`);
  return inside.split(",").filter((part) => part.trim()).map((part) => Number.parseInt(part, 10));
}

const NAMES: Record<string, string> = {
  ...{ u: "uint", i: "int", f: "float", c: "complex", b: "bool", O: "object" },
  ...{ U: "str", S: "bytes", V: "void", M: "datetime", m: "timedelta" },
};

function dtype(descr: string, name: string): Pick<NpyHeader, "kind" | "bytes" | "little" | "type"> {
  if (descr.startsWith("[") || descr.startsWith("(")) {
    const kind = /['"][<>=|]?O\d*['"]/.test(descr) ? "O" : "V";
    return { kind, bytes: 0, little: true, type: descr };
  }
  const match = /^['"]([<>=|]?)([uifcbOUSVMm])(\d*)(\[.*\])?['"]$/.exec(descr);
  if (!match) throw damaged(name, `its header names an unknown type, ${descr}`);
  const [, order, kind, digits] = match;
  const size = Number(digits || (kind === "O" ? 8 : 1)) * (kind === "U" ? 4 : 1);
  const valid: Record<string, number[]> = {
    ...{ u: [1, 2, 4, 8], i: [1, 2, 4, 8], f: [2, 4, 8, 12, 16], c: [8, 16, 24, 32], b: [1] },
  };
  if (valid[kind!] && !valid[kind!]!.includes(size)) {
    throw damaged(name, `its header names an unknown type, ${descr}`);
  }
  const type = kind === "b" || kind === "O" ? NAMES[kind]! : `${NAMES[kind!]}${8 * size}`;
  return { kind: kind!, bytes: size, little: order !== ">", type };
}
