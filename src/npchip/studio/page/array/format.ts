/** Bytes as text and as shades. */

export type Base = "decimal" | "hex" | "signed";

/** Return a byte as text: `200`, `C8` or `-56`. */
export function format(byte: number, base: Base): string {
  if (base === "hex") return hex(byte);
  return String(base === "signed" ? signed(byte) : byte);
}

/** Return two hexadecimal digits. */
export function hex(byte: number): string {
  return byte.toString(16).toUpperCase().padStart(2, "0");
}

/** Return eight binary digits, in two groups that the eye can take in. */
export function binary(byte: number): string {
  const digits = byte.toString(2).padStart(8, "0");
  return `${digits.slice(0, 4)} ${digits.slice(4)}`;
}

/** Return a byte as a number in two's complement. */
export function signed(byte: number): number {
  return byte < 128 ? byte : byte - 256;
}

/** Return the shade of a byte, 0 black; signed numbers have 0 in the middle. */
export function shade(byte: number, base: Base): number {
  return base === "signed" ? byte ^ 128 : byte;
}

/** Return black or white, whichever reads better on a shade: the contrast is at least 4.5. */
export function inkOn(grey: number): "black" | "white" {
  return grey < 118 ? "white" : "black";
}

/** Return the CSS colour of a shade. */
export function greyOf(level: number): string {
  return `rgb(${level} ${level} ${level})`;
}

/** Return the number that a reader typed, decimal or with `0x` or `0b`; null if it is none. */
export function parseNumber(text: string): number | null {
  const plain = text.trim().toLowerCase();
  return /^(\d+|0x[\da-f]+|0b[01]+)$/.test(plain) ? Number(plain) : null;
}
