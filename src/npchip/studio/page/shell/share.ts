/**
 * A program in the address: `#code=` and its files, deflated, in the alphabet of URLs.
 *
 * The part of an address after `#` never leaves the browser.
 */

import type { Project } from "../protocol";

/** Contents of a link. The clip is a bundled one: a link never starts the camera. */
export interface Shared {
  project: Project;
  clip: string | null;
  machine: string;
  /** Text of the machine file, if it is no bundled machine. */
  machineText?: string;
  /** The bundled example whose bytes lie in the NPs' memory. */
  memoryOf?: string;
}

/** Most bytes that a link may unpack to: the assembler's limit for a source with its includes. */
const MOST = 1 << 18;
const DAMAGED = "the link is damaged or incomplete: ask for it again";

export async function toLink(shared: Shared): Promise<string> {
  const text = JSON.stringify({ v: 1, ...shared });
  const packed = await bytesOf(
    new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw")),
    Infinity,
  );
  const letters = Array.from(packed, (byte) => String.fromCharCode(byte)).join("");
  return `#code=${btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
}

/** Return what the part of an address after `#` holds; null if it holds no program.
 * @throws Error if it is damaged. */
export async function fromLink(hash: string): Promise<Shared | null> {
  const code = /^#code=(.*)$/.exec(hash)?.[1];
  if (code === undefined) return null;
  let found: unknown;
  try {
    const letters = atob(code.replaceAll("-", "+").replaceAll("_", "/"));
    const packed = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream();
    const bytes = await bytesOf(
      stream.pipeThrough(new DecompressionStream("deflate-raw")),
      2 * MOST,
    );
    found = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
  } catch {
    throw new Error(DAMAGED);
  }
  return checked(found);
}

/** Return a stored or sent project if it is one. */
export function checked(found: unknown): Shared {
  const { v, project, clip, machine, machineText, memoryOf } = Object(found) as Record<string, unknown>;
  if (v !== 1 && v !== undefined) {
    throw new Error("the link was made by a newer npchip: reload this page, or update it");
  }
  const { main, files } = Object(project) as Record<string, unknown>;
  const names = Object.keys(Object(files) as object);
  const whole =
    typeof main === "string" &&
    names.includes(main) &&
    Object.values(Object(files) as object).every((text) => typeof text === "string") &&
    names.every(isName) &&
    (typeof clip === "string" || clip === null) &&
    typeof machine === "string" &&
    isTextOrMissing(machineText) &&
    isTextOrMissing(memoryOf);
  if (!whole) throw new Error(DAMAGED);
  return {
    project: { main, files: files as Record<string, string> },
    clip,
    machine,
    ...(machineText === undefined ? {} : { machineText }),
    ...(memoryOf === undefined ? {} : { memoryOf }),
  };
}

function isTextOrMissing(found: unknown): found is string | undefined {
  return found === undefined || typeof found === "string";
}

/** Return whether a text can name a file of a project: a relative path that stays inside. */
export function isName(name: string): boolean {
  const parts = name.split("/");
  return name.length <= 200 && parts.every((part) => /^[\w-][\w .+-]*$/.test(part));
}

async function bytesOf(stream: ReadableStream<Uint8Array>, most: number): Promise<Uint8Array> {
  const parts: Uint8Array<ArrayBuffer>[] = [];
  let length = 0;
  const reader = stream.getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    length += value.length;
    if (length > most) {
      await reader.cancel();
      throw new Error(DAMAGED);
    }
    parts.push(value as Uint8Array<ArrayBuffer>);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}
