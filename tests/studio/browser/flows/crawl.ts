/** Press everything that can be pressed. */

import { check } from "../driver/expect";
import { flow } from "../driver/flow";
import type { Session } from "../driver/session";
import { assembling, ended, opened } from "../driver/studio";

const PRESSABLE = "button, summary, [role=button], [role=tab], [role=menuitem], input[type=radio], input[type=checkbox]";
/** More buttons than the page can have. */
const MOST = 500;

/** Buttons that may have the page say a problem without being broken, and what they say. */
const HARMLESS: [RegExp, RegExp][] = [[/Copy/, /clipboard/]];

/** Whether the program in the page is another one than at the beginning. */
function changed(): boolean {
  const { main, files } = npchip.store.project.value;
  return main !== "trajectory.s" || npchip.store.diagnostics.value.length > 0 || !files["lib/moving_box.s"];
}

/** Press the first control that was not pressed yet, and return its name; null if there is none. */
function pressNext(t: Session, done: string[]): Promise<string | null> {
  return t.page.evaluate(
    (selector, before) => {
      const dialog = document.querySelector<HTMLDialogElement>("dialog[open]");
      const found = [...(dialog ?? document).querySelectorAll<HTMLElement>(selector)];
      // What closes a dialog comes last in it.
      if (dialog) found.sort((a, b) => Number(/close|cancel/i.test(a.innerText)) - Number(/close|cancel/i.test(b.innerText)));
      for (const element of found) {
        const name = `${element.getAttribute("role") ?? element.tagName.toLowerCase()} ${
          element.getAttribute("aria-label") ?? element.closest("label")?.innerText ?? element.innerText
        }`
          .trim()
          .replace(/\d+/g, "#");
        const off = (element as HTMLButtonElement).disabled || element.getAttribute("aria-disabled") === "true";
        if (off || !element.checkVisibility() || before.includes(name)) continue;
        element.scrollIntoView({ block: "center" });
        element.focus();
        element.click();
        return name;
      }
      if (dialog) {
        dialog.close();
        return "";
      }
      return null;
    },
    PRESSABLE,
    done,
  );
}

async function crawl(t: Session): Promise<void> {
  await t.page.evaluateOnNewDocument(() => {
    // The dialog of the system for choosing a file cannot be closed from here.
    const click = HTMLInputElement.prototype.click;
    HTMLInputElement.prototype.click = function (this: HTMLInputElement) {
      if (this.type !== "file") click.call(this);
    };
  });
  await opened(t);
  await assembling(t);
  await ended(t);
  const done: string[] = [];
  // Twice over, as some can be pressed only after others.
  for (let idle = 0; idle < 2 && done.length < MOST; ) {
    await t.page.evaluate(() => {
      npchip.store.message.value = { kind: "info", text: "" }; // what is said next is of the next button
    });
    const name = await pressNext(t, done);
    if (name === null) {
      idle += 1;
      await t.press("Reset");
      await t.until("the chip is reset", () => {
        const { running, view } = npchip.store;
        return !running.value && view.value?.instructions === 0;
      });
      await t.page.evaluate(() => npchip.act().run());
      await t.until("frames come", () => npchip.store.frameCount.value > 2);
      continue;
    }
    if (name) done.push(name);
    await t.until("the page answers", () => npchip.store.progress.value === null, [], { timeout: 60_000 });
    const said = await t.page.evaluate(() => {
      const { message } = npchip.store;
      const found = message.value;
      message.value = { kind: "info", text: "" };
      return found;
    });
    // What one had said may come when the next is pressed.
    const pair = done.slice(-2);
    const harmless = HARMLESS.some(
      ([button, text]) => text.test(said.text) && pair.some((each) => button.test(each)),
    );
    check(said.kind !== "error" || harmless, `after '${pair.join("', '")}' the page has a problem: ${said.text}`);
    // Some change the program: without it other buttons could do nothing.
    if (await t.page.evaluate(changed)) {
      await t.page.evaluate(() => document.querySelector<HTMLDialogElement>("dialog[open]")?.close());
      await t.choose("Example", "edges");
      await t.choose("Example", "trajectory");
      await t.until("the example is open again", () => npchip.store.program.value?.name === "trajectory");
    }
  }
  check(done.length < MOST, `the page has more than ${MOST} buttons`);
  const pressed = done.map((name) => name.replace(/^\S+ /, ""));
  for (const name of ["Run", "Pause", "Reset", "Step", "Step back", "Save", "Share", "Help"]) {
    check(pressed.includes(name), `the button '${name}' could not be pressed; pressed were ${pressed.join(", ")}`);
  }
  t.report["pressed"] = pressed;
}

flow("crawl: every button, light", crawl, { theme: "light", seconds: 180 });
flow("crawl: every button, dark, on a phone", crawl, { theme: "dark", width: 360, height: 740, seconds: 180 });
