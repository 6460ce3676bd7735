/** What flows do in the studio again and again. */

import { check } from "./expect";
import type { Session } from "./session";

/** Milliseconds for the assembler to load into a new context on a busy machine. */
export const LOADING = 45_000;

/** Open the page and wait until its first picture moves. */
export async function opened(t: Session): Promise<void> {
  await t.open();
  await moving(t);
}

/** Open an example that does not start by itself, and wait until it can be run. */
export async function openExample(t: Session, example: string, clip: string): Promise<void> {
  await t.open(`#example=${example}&clip=${clip}`);
  await t.until(
    `${example} is open with ${clip}`,
    (name, film) => {
      const { compiled, clip: now } = npchip.store;
      const found = now.value && now.value !== "live" && now.value.name.includes(film);
      return compiled.value?.program?.name === name && found;
    },
    [example, clip] as const,
    { timeout: LOADING },
  );
}

/** Wait until the first picture has moved. */
export async function moving(t: Session): Promise<void> {
  await marked(t, "npchip:first-picture", "the first picture moves");
}

/** Wait until the page can assemble. */
export async function assembling(t: Session): Promise<void> {
  await marked(t, "npchip:compiler-ready", "the assembler has loaded");
}

async function marked(t: Session, mark: string, what: string): Promise<void> {
  const there = (name: string) => performance.getEntriesByName(name).length > 0;
  await t.until(what, there, [mark] as const, { timeout: LOADING });
}

/** Wait until the chip stands still. */
export async function still(t: Session, timeout = LOADING): Promise<void> {
  await t.until("the chip stands still", () => !npchip.store.running.value, [], { timeout });
}

/** Wait until the run has reached its end, and return how. */
export async function ended(t: Session, timeout = LOADING): Promise<string> {
  await still(t, timeout);
  const ends = () => npchip.store.view.value?.ended && npchip.store.view.value.status;
  return (await t.until("the run is over", ends, [], { timeout })) as string;
}

/** Number of instructions that the chip has executed. */
export function instructions(t: Session): Promise<number> {
  return t.page.evaluate(() => npchip.store.view.value?.instructions ?? -1);
}

/** Press a button that moves the chip, and wait until it has moved and stands still. */
export async function travel(t: Session, button: string): Promise<number> {
  const before = await instructions(t);
  await t.press(button);
  await t.until(
    `'${button}' has moved the chip`,
    (was) => !npchip.store.running.value && npchip.store.view.value?.instructions !== was,
    [before] as const,
  );
  return instructions(t);
}

/** Wait until the newest text has been assembled, and return the texts of its mistakes. */
export async function mistakes(t: Session, holds: "some" | "none"): Promise<string[]> {
  return t.until(
    `the program has ${holds === "some" ? "a mistake" : "no mistake"}`,
    (wanted) => {
      const found = npchip.store.diagnostics.value.filter((each) => each.severity === "error");
      const fits = npchip.store.compiled.value && found.length > 0 === (wanted === "some");
      return fits ? found.map((each) => each.message) : null;
    },
    [holds] as const,
    { timeout: LOADING },
  ) as Promise<string[]>;
}

/** The text of the page that a reader sees. */
export function seen(t: Session): Promise<string> {
  return t.page.evaluate(() => document.body.innerText);
}

/** Fail unless the page says something. */
export async function says(t: Session, pattern: RegExp): Promise<void> {
  const text = await seen(t);
  check(pattern.test(text), `the page does not say ${pattern}`);
}

/** Put files into a file box, as a reader does by way of its dialog. */
export async function give(t: Session, box: string, paths: string[]): Promise<void> {
  const input = await t.page.$(`input[type=file][aria-label="${box}"]`);
  check(input, `the page has no file box '${box}'`);
  await (input as unknown as { uploadFile(...paths: string[]): Promise<void> }).uploadFile(...paths);
}
