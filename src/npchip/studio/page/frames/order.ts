/** The natural order of file names, with numbers below zero and time stamps, as npchip's. */

const COUNTED = /(-?)([0-9]+)/g;
/** Signs and numbers that may have digits behind a point. */
const TIMED = /(-?)((?<![0-9.])[0-9]+\.[0-9]+(?![.0-9])|[0-9]+)/g;
const MARKS = "_=,;:(+";

type Piece = string | Decimal;
interface Decimal {
  negative: boolean;
  whole: string;
  fraction: string;
}

/**
 * Sort paths in natural order: 2 before 10, -2 before -1, 0.25 before 0.5.
 *
 * A minus is a sign if it follows a mark such as `_`, or if a name has a digit in its place
 * (`t-1` beside `t0`). Digits behind a single point are a fraction, unless lengths differ and one
 * of them ends in 0: then `1.10` follows `1.9`.
 */
export function inOrder<Item>(items: readonly Item[], path: (item: Item) => string): Item[] {
  const split = items.map((item) => ({ item, path: path(item), ...parts(path(item)) }));
  const names = new Set(split.flatMap((one) => one.names));
  const numbers = haveFractions(names) ? TIMED : COUNTED;
  const unsigned = new Set<string>();
  for (const name of names) {
    for (const found of name.matchAll(/[0-9]+/g)) unsigned.add(name.slice(0, found.index));
  }
  const keyed = split.map((one) => ({
    ...one,
    key: [...one.names.map((name) => pieces(name, numbers, unsigned)), [one.suffix]],
  }));
  // Names that are equal in natural order keep a fixed order too.
  keyed.sort((a, b) => compareText(a.path, b.path));
  keyed.sort((a, b) => compareLists(a.key, b.key, (x, y) => compareLists(x, y, comparePieces)));
  return keyed.map((one) => one.item);
}

/** Split a path into its folders, its name without the suffix, and that. */
function parts(path: string): { names: string[]; suffix: string } {
  const folders = path.split("/");
  const last = folders.pop()!;
  const point = last.lastIndexOf(".");
  const cut = point > 0 && point < last.length - 1 ? point : last.length;
  return { names: [...folders, last.slice(0, cut)], suffix: last.slice(cut) };
}

function pieces(name: string, numbers: RegExp, unsigned: Set<string>): Piece[] {
  const found: Piece[] = [];
  let end = 0;
  for (const match of name.matchAll(numbers)) {
    const before = name.slice(0, match.index);
    const marked = before === "" || MARKS.includes(before.slice(-1));
    const signed = match[1] !== "" && (marked || unsigned.has(before));
    const start = signed ? match.index : match.index + match[1]!.length;
    found.push(name.slice(end, start), decimal(match[2]!, signed));
    end = match.index + match[0].length;
  }
  return [...found, name.slice(end)];
}

function decimal(digits: string, negative: boolean): Decimal {
  const [whole, fraction = ""] = digits.split(".");
  return { negative, whole: whole!, fraction };
}

/** Tell fractions from numbers of their own by zeros at their ends, which a fraction drops. */
function haveFractions(names: Iterable<string>): boolean {
  const behind: string[] = [];
  for (const name of names) {
    for (const match of name.matchAll(TIMED)) behind.push(match[2]!.split(".")[1] ?? "");
  }
  const lengths = new Set(behind.filter(Boolean).map((digits) => digits.length));
  return lengths.size <= 1 || !behind.some((digits) => digits.length > 1 && digits.endsWith("0"));
}

function compareLists<T>(a: T[], b: T[], compare: (x: T, y: T) => number): number {
  for (let at = 0; at < Math.min(a.length, b.length); at++) {
    const order = compare(a[at]!, b[at]!);
    if (order !== 0) return order;
  }
  return a.length - b.length;
}

function comparePieces(a: Piece, b: Piece): number {
  if (typeof a === "string" && typeof b === "string") return compareText(folded(a), folded(b));
  if (typeof a === "object" && typeof b === "object") return compareNumbers(a, b);
  return typeof a === "string" ? -1 : 1;
}

function compareNumbers(a: Decimal, b: Decimal): number {
  const places = Math.max(a.fraction.length, b.fraction.length);
  const [x, y] = [a, b].map(({ negative, whole, fraction }) => {
    const value = BigInt(whole + fraction.padEnd(places, "0"));
    return negative ? -value : value;
  }) as [bigint, bigint];
  return x < y ? -1 : x > y ? 1 : 0;
}

/** Drop the difference of small and capital letters, and of ways to write an accent. */
function folded(name: string): string {
  return name.normalize("NFD").toUpperCase().toLowerCase();
}

/** Compare by code points; strings by themselves compare halves of characters. */
function compareText(a: string, b: string): number {
  return compareLists([...a], [...b], (x, y) => x.codePointAt(0)! - y.codePointAt(0)!);
}
