/** Say what was expected and what came instead. */

import { isDeepStrictEqual } from "node:util";

/** Fail unless a condition holds. */
export function check(condition: unknown, message: string): asserts condition {
  if (!condition) throw new Error(message);
}

/** Fail unless two values are equal all the way down. */
export function equal(found: unknown, wanted: unknown, what: string): void {
  if (isDeepStrictEqual(found, wanted)) return;
  throw new Error(`${what}: expected ${short(wanted)}, found ${short(found)}`);
}

function short(value: unknown): string {
  const text = JSON.stringify(value) ?? String(value);
  return text.length > 3000 ? `${text.slice(0, 3000)} …` : text;
}
