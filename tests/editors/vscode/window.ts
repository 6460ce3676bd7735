/** A window of VS Code in a browser, as a reader uses it: by keys, buttons and what can be seen. */

import { writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Frame, Page } from "puppeteer-core";

/** Milliseconds to wait for what takes no time; a browser on a busy machine may take some. */
const PATIENCE = 60_000;

/** Milliseconds after which a box that closed, or a list that stayed empty, is asked for again. */
const AGAIN = 5_000;

export class Window {
  #pictures = 0;

  constructor(
    readonly page: Page,
    /** What the test gives. */
    readonly given: Record<string, string>,
  ) {}

  /** A text that the test gives. */
  parameter(name: string): string {
    const found = this.given[name];
    if (found === undefined) throw new Error(`the test gives no '${name}'`);
    return found;
  }

  /** Open a folder. */
  async open(url: string, folder: string): Promise<void> {
    await this.page.goto(`${url}?folder=${encodeURIComponent(folder)}`, { waitUntil: "load" });
    await this.sees(".monaco-workbench .explorer-folders-view .monaco-list-row", "the folder's files");
  }

  /** Press keys, such as `Control+Shift+P`. */
  async keys(chord: string): Promise<void> {
    const parts = chord.split("+");
    const last = parts.pop() ?? "";
    for (const part of parts) await this.page.keyboard.down(part as "Control");
    await this.page.keyboard.press(last as "Enter");
    for (const part of parts.reverse()) await this.page.keyboard.up(part as "Control");
  }

  /** Type into what has the focus. */
  async type(text: string): Promise<void> {
    await this.page.keyboard.type(text, { delay: 5 });
  }

  /** Run a command by its title. */
  async command(title: string): Promise<void> {
    await this.choose("F1", `>${title}`, title);
    await this.closed();
  }

  /** Run a command that goes on to ask, and answer it. */
  async asking(title: string, answer: string): Promise<void> {
    await this.choose("F1", `>${title}`, title);
    await this.until("the command asks", () => !document.querySelector<HTMLInputElement>(".quick-input-widget input")?.value, []);
    await this.answer(answer, answer);
    await this.closed();
  }

  /**
   * Open the box at the top of the window, and take a choice. What takes the focus late, such as a
   * walkthrough that has just been opened, closes the box; then it is opened again.
   */
  async choose(chord: string, text: string, choice: string): Promise<void> {
    for (let end = Date.now() + PATIENCE; ; ) {
      await this.keys(chord);
      try {
        await this.answer(text, choice, AGAIN);
        return;
      } catch (error) {
        if (Date.now() > end) throw error;
        await this.keys("Escape");
      }
    }
  }

  /** Write into the box at the top of the window, wait for a choice with a text if there is one, and take it. */
  async answer(text: string, choice = "", patience = PATIENCE): Promise<void> {
    await this.sees(".quick-input-widget input", "a box to write into", "", patience);
    await this.keys("Control+a");
    await this.type(text);
    if (choice) await this.sees(".quick-input-list .monaco-list-row.focused", `the choice '${choice}'`, choice, patience);
    await this.keys("Enter");
  }

  /** Wait until the box at the top of the window is closed. */
  async closed(): Promise<void> {
    await this.until("the box is closed", () => !document.querySelector(".quick-input-widget")?.getClientRects().length, []);
  }

  /** Show a file of the folder. */
  async show(file: string): Promise<void> {
    await this.choose("Control+p", file, file);
    await this.closed();
    await this.sees(".tab.active", `the tab of ${file}`, file);
    await this.sees(".editor-instance .view-line", "the text");
  }

  /** Put the cursor at a line and column, which count from 1. */
  async at(line: number, column = 1): Promise<void> {
    await this.choose("Control+g", `:${line}:${column}`, `line ${line} at column ${column}`);
    await this.closed();
  }

  /** Wait until an element can be seen, with a text in it whatever its blanks, and return its text. */
  async sees(selector: string, what: string, text = "", patience = PATIENCE): Promise<string> {
    return this.until(
      `${what} can be seen`,
      (wanted, part) => {
        const shown = [...document.querySelectorAll<HTMLElement>(wanted)].filter((item) => item.getClientRects().length);
        const bare = (words: string | null) => (words ?? "").replaceAll(/\s/g, "");
        const found = shown.find((item) => bare(item.innerText).includes(bare(part)) || bare(item.ariaLabel).includes(bare(part)));
        return found && (found.innerText || found.ariaLabel || " ").replaceAll("\u00a0", " ");
      },
      [selector, text],
      this.page,
      patience,
    );
  }

  /** Wait until no such element can be seen. */
  async lacks(selector: string, what: string): Promise<void> {
    await this.until(`${what} is gone`, (wanted) => !document.querySelector(wanted), [selector]);
  }

  /** Press a button by its name. */
  async press(name: string): Promise<void> {
    const selector = `[role=button][aria-label^="${name}"], button[aria-label^="${name}"]`;
    await this.sees(selector, `the button '${name}'`);
    await this.page.click(selector);
  }

  /** Wait until a function in the page, or in a frame of it, returns something true; return that. */
  async until<P extends readonly (string | number)[], R>(
    what: string,
    condition: (...parameters: P) => R,
    parameters: P,
    frame: Page | Frame = this.page,
    patience = PATIENCE,
  ): Promise<NonNullable<R>> {
    const waiting = { timeout: patience, polling: 50 };
    const handle = await frame
      .waitForFunction(condition as unknown as (...all: unknown[]) => R, waiting, ...parameters)
      .catch((error: unknown) => {
        throw new Error(`waited in vain until ${what}`, { cause: error });
      });
    return (await handle.jsonValue()) as NonNullable<R>;
  }

  /** Wait until the debugger has stopped before a line: it is marked, and the cursor is there. */
  async stopsAt(line: number): Promise<void> {
    await this.until(
      `the program stops at line ${line}`,
      (wanted) => {
        const at = document.querySelector<HTMLElement>("[id='status.editor.selection']")?.innerText ?? "";
        return at.startsWith(`Ln ${wanted},`) && document.querySelector(".debug-top-stack-frame-line");
      },
      [line],
    );
  }

  /** The frame of the page of a web view that has such an element. */
  async inside(selector: string, what: string): Promise<Frame> {
    const end = Date.now() + PATIENCE;
    while (Date.now() < end) {
      for (const frame of this.page.frames()) {
        if (frame === this.page.mainFrame()) continue;
        if (await frame.$(selector).catch(() => null)) return frame;
      }
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
    throw new Error(`waited in vain until ${what} can be seen`);
  }

  /** Keep a picture of the window. */
  async picture(name: string): Promise<void> {
    const number = String(++this.#pictures).padStart(2, "0");
    writeFileSync(join(this.parameter("pictures"), `${number}-${name}.png`), await this.page.screenshot());
  }
}
