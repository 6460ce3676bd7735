/** A page in a context of its own, as a flow sees it. */

import { readdir, readFile, stat } from "node:fs/promises";
import { join } from "node:path";
import type { ElementHandle, Page } from "puppeteer-core";
import type { Kind, Options } from "./flow";
import "./hook";
import type { Watch } from "./watch";

/** Milliseconds to wait for what takes no time; a browser on a busy machine may take some. */
export const PATIENCE = 15_000;

export interface Job {
  flow: string;
  /** Address of the page. */
  url: string;
  /** Folder for downloads, and for what a failed flow leaves behind. */
  folder: string;
  /** What a test hands to the flow. */
  parameters: Record<string, unknown>;
}

export interface Waiting {
  /** Milliseconds. */
  timeout?: number;
}

export class Session {
  /** What the flow reports to the test, such as measurements. */
  readonly report: Record<string, unknown> = {};

  constructor(
    readonly page: Page,
    readonly kind: Kind,
    readonly job: Job,
    readonly options: Options,
    readonly watch: Watch,
    readonly downloads: string,
    /** Path of axe, a script for the page. */
    readonly axe: string,
  ) {}

  /** A parameter that the test has given. */
  parameter<T>(name: string): T {
    const value = this.job.parameters[name];
    if (value === undefined) throw new Error(`the test gives no parameter '${name}'`);
    return value as T;
  }

  /** Open the page, with something behind its address. */
  async open(rest = ""): Promise<void> {
    await this.page.goto(this.job.url + rest, { waitUntil: "load" });
  }

  /** Return the control of a role and accessible name, once it can be seen. */
  async control(role: string, name: string, { timeout = PATIENCE }: Waiting = {}) {
    const found = await this.page
      .waitForSelector(`aria/${name}[role="${role}"]`, { visible: true, timeout })
      .catch((error: unknown) => {
        throw new Error(`the page has no ${role} '${name}' that can be seen`, { cause: error });
      });
    if (!found) throw new Error(`the page has no ${role} '${name}'`);
    return found as ElementHandle<HTMLElement>;
  }

  /** Press a button as soon as it can be pressed. */
  async press(name: string, waiting: Waiting = {}): Promise<void> {
    const button = await this.control("button", name, waiting);
    await this.until(`the button '${name}' can be pressed`, enabled, [button], waiting);
    await button.evaluate((element) => element.scrollIntoView({ block: "center" }));
    await button.click();
    await button.dispose();
  }

  /** Choose an option of a combobox by its text, or by a text that contains it. */
  async choose(name: string, option: string): Promise<void> {
    const select = await this.control("combobox", name);
    const value = await this.until(
      `the combobox '${name}' has an option '${option}'`,
      (element, text) => {
        const options = [...(element as HTMLSelectElement).options];
        const plain = (o: HTMLOptionElement) => o.label.trim().toLowerCase();
        const exact = options.find((o) => plain(o) === text || o.value === text);
        return (exact ?? options.find((o) => plain(o).includes(text)))?.value;
      },
      [select, option.toLowerCase()] as const,
    );
    await select.select(value as string);
    await select.dispose();
  }

  /**
   * Wait until a function in the page returns something true, and return it.
   * `what` completes the sentence "waited in vain until …".
   */
  async until<P extends readonly unknown[], R>(
    what: string,
    condition: (...parameters: Inside<P>) => R,
    parameters: P = [] as unknown as P,
    { timeout = PATIENCE }: Waiting = {},
  ): Promise<R> {
    const signal = this.watch.broken;
    const waiting = { timeout, polling: 50, signal };
    const handle = await this.page
      .waitForFunction(condition as (...all: unknown[]) => R, waiting, ...parameters)
      .catch(async (error: unknown) => {
        const [fault] = this.watch.faults;
        const why = fault ? `as the page is at fault: ${fault}` : `for ${timeout / 1000} s`;
        const said = await this.page.evaluate(() => {
          const status = document.querySelector("[role=status][aria-label=Messages]");
          return status?.textContent ?? "";
        });
        const text = `waited in vain until ${what}, ${why}; the page says '${said}'`;
        throw new Error(text, { cause: error });
      });
    return (await handle.jsonValue()) as R;
  }

  /** The rows of the table `Outputs`, each a list of texts; the first one holds the heads. */
  async outputs(): Promise<string[][]> {
    const table = await this.control("table", "Outputs");
    return table.evaluate((element) =>
      [...element.querySelectorAll("tr, [role=row]")].map((row) =>
        [...row.querySelectorAll("th, td, [role=columnheader], [role=cell], [role=gridcell], [role=rowheader]")].map(
          (cell) => (cell.textContent ?? "").trim(),
        ),
      ),
    );
  }

  /** Wait until the status `Messages` says something that matches, and return it. */
  async message(pattern: RegExp, waiting: Waiting = {}): Promise<string> {
    const status = await this.control("status", "Messages", waiting);
    const found = await this.until(
      `the status 'Messages' says ${pattern}`,
      (element, source, flags) => {
        const text = (element as HTMLElement).innerText;
        return new RegExp(source, flags).test(text) ? text : "";
      },
      [status, pattern.source, pattern.flags] as const,
      waiting,
    );
    return found;
  }

  /** Replace what the textbox `Program` holds, as a reader does with the keyboard. */
  async write(text: string): Promise<void> {
    const editor = await this.control("textbox", "Program");
    await editor.focus(); // a click into the middle of a long text may hit what covers it
    await this.chord("Control", "a");
    await this.page.keyboard.press("Delete");
    // Pasted at once: typing would have words and indents completed.
    await editor.evaluate((element, pasted) => {
      element.focus();
      const clipboardData = { types: ["text/plain"], files: [], getData: () => pasted };
      const paste = new ClipboardEvent("paste", { bubbles: true, cancelable: true });
      // Firefox gives an event that a script has made no text.
      Object.defineProperty(paste, "clipboardData", { value: clipboardData });
      if (element.dispatchEvent(paste)) document.execCommand("insertText", false, pasted);
    }, text);
  }

  /** The text of the program, all of it: the editor draws only what is seen. */
  program(): Promise<string> {
    return this.page.evaluate(() => {
      const { main, files } = npchip.store.project.value;
      return files[main] ?? "";
    });
  }

  /** Press a key while another is held. */
  async chord(held: "Control" | "Shift" | "Alt", key: string): Promise<void> {
    await this.page.keyboard.down(held);
    await this.page.keyboard.press(key as "a");
    await this.page.keyboard.up(held);
  }

  /** Wait for a file that the page saves, and return its name and bytes. */
  async saved(act: () => Promise<void>): Promise<{ name: string; bytes: Buffer }> {
    const before = await this.#downloaded();
    await act();
    const end = Date.now() + PATIENCE;
    while (Date.now() < end) {
      const now = [...(await this.#downloaded())];
      // One of the same name may have been there.
      const names = now.filter(([name, time]) => before.get(name) !== time).map(([name]) => name);
      const partial = names.some((name) => /\.(part|crdownload|tmp)$|^\.com\./.test(name));
      const [name] = names;
      if (name !== undefined && !partial) {
        const bytes = await readFile(join(this.downloads, name));
        if (bytes.length > 0) return { name, bytes };
      }
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`the page saved no file within ${PATIENCE / 1000} s`);
  }

  /** The downloaded files with the times of their last changes. */
  async #downloaded(): Promise<Map<string, number>> {
    const found = new Map<string, number>();
    for (const name of await readdir(this.downloads)) {
      const about = await stat(join(this.downloads, name)).catch(() => null); // renamed meanwhile
      if (about) found.set(name, about.mtimeMs);
    }
    return found;
  }
}

/** What a function in the page gets for its parameters: elements for handles. */
type Inside<P extends readonly unknown[]> = {
  [K in keyof P]: P[K] extends ElementHandle<infer E> ? E : P[K];
};

function enabled(element: Element): boolean {
  return !(element as HTMLButtonElement).disabled && element.getAttribute("aria-disabled") !== "true";
}
