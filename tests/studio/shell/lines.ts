/** Where lines of a text were before edits. Prints a list, as JSON. */

import { addressesOf, lineIn } from "../../../src/npchip/studio/page/shell/places";
import type { CompileRequest, ProgramInfo } from "../../../src/npchip/studio/page/protocol";

const OLD = "a\nb\nc\nd\ne";
const all = (now: string): (number | null)[] => now.split("\n").map((_, at) => lineIn(OLD, now, at + 1));

const word = (line: number) => ({ origins: [{ file: "x.s", line }], text: "", cycles: 1 });
const program = { words: [1, 1, 2, 1].map(word) } as ProgramInfo;
const origin = { project: { main: "x.s", files: { "x.s": "first\nsecond" } } } as unknown as CompileRequest;
const at = (now: string | undefined, line: number) => addressesOf(program, origin, "x.s", now, line);
console.log(
  JSON.stringify({
    same: all(OLD),
    pushed: all("new\na\nb\nc\nd\ne"),
    deleted: all("a\nd\ne"),
    edited: all("a\nb\nC\nd\ne"),
    two: all("a\nnew\nb\nc\nd\nlast\ne"),
    twins: lineIn("a\nx\ny\nx\ne", "a\nnew\nx\nz\nx\nnew\ne", 3),
    addresses: [at("first\nsecond", 1), at("new\nfirst\nsecond", 2), at("new\nfirst\nsecond", 1), at(undefined, 2)],
  }),
);
