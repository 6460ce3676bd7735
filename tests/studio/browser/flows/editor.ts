/** Write with the keyboard: tabs, completion, cards, jumps, breakpoints, mistakes, undo. */

import { check, equal } from "../driver/expect";
import { flow } from "../driver/flow";
import type { Session } from "../driver/session";
import { assembling, mistakes, openExample } from "../driver/studio";

const MAIN = "trajectory.s";

/** Open the example and put the focus into its text. */
async function start(t: Session): Promise<void> {
  await openExample(t, "trajectory", "coin_slide");
  await assembling(t);
  await (await t.control("textbox", "Program")).focus();
}

/** Put the cursor at the begin of the line that matches. */
async function goTo(t: Session, pattern: RegExp): Promise<number> {
  const line = await t.page.evaluate((source) => {
    const { openFile, project } = npchip.store;
    const lines = (project.value.files[openFile.value] ?? "").split("\n");
    const found = lines.findIndex((text) => new RegExp(source).test(text)) + 1;
    npchip.act().show(openFile.value, found);
    return found;
  }, pattern.source);
  check(line > 0, `no line matches ${pattern}`);
  await t.until("the cursor is there", (at) => npchip.store.cursor.value?.line === at, [line] as const);
  await (await t.control("textbox", "Program")).focus();
  return line;
}

async function press(t: Session, key: string, times = 1): Promise<void> {
  for (let count = 0; count < times; count += 1) await t.page.keyboard.press(key as "F1");
}

function openFile(t: Session): Promise<string> {
  return t.page.evaluate(() => npchip.store.openFile.value);
}

function fileText(t: Session, name: string): Promise<string | undefined> {
  return t.page.evaluate((file) => npchip.store.project.value.files[file], name);
}

function tip(t: Session, pattern: RegExp): Promise<unknown> {
  return t.until(
    `a tip says ${pattern}`,
    (source) => {
      const all = [...document.querySelectorAll(".cm-tooltip")].map((each) => each.textContent ?? "");
      return all.some((text) => new RegExp(source).test(text));
    },
    [pattern.source] as const,
  );
}

flow("editor: tabs by keyboard, files deleted, brought back and renamed", async (t) => {
  await start(t);
  await (await t.control("tab", MAIN)).focus();
  await press(t, "End");
  await t.until("the last tab is open", (main) => npchip.store.openFile.value !== main, [MAIN] as const);
  const last = await openFile(t);
  const text = await fileText(t, last);
  const focused = (name: string): boolean => document.activeElement?.textContent === name;
  await t.until("its tab has the focus", focused, [last] as const);
  await press(t, "Delete");
  await t.until("it is deleted", (name) => !(name in npchip.store.project.value.files), [last] as const);
  equal(await openFile(t), MAIN, "the file that is open then");
  await mistakes(t, "none"); // npchip's library has a file of that name
  await t.press("Undo");
  equal(await fileText(t, last), text, "the text that was brought back");
  await t.until("its tab has the focus again", focused, [last] as const);
  await press(t, "F2");
  await t.until("a name is asked for", () => document.activeElement instanceof HTMLInputElement);
  await t.chord("Control", "a");
  await t.page.keyboard.type("lib/other.s");
  await press(t, "Enter");
  await t.until("it has its new name", () => npchip.store.openFile.value === "lib/other.s");
  equal(await fileText(t, "lib/other.s"), text, "the text under the new name");
  await mistakes(t, "none");
  await t.press("Undo");
  await t.until("it has its old name again", (name) => npchip.store.openFile.value === name, [last] as const);
  await mistakes(t, "none");
});

flow("editor: a breakpoint moves with its line, and its condition is checked", async (t) => {
  await start(t);
  const line = await goTo(t, /^frame:/);
  await press(t, "F9");
  await goTo(t, /^\.equ THRESHOLD/);
  await press(t, "End");
  await press(t, "Enter");
  const stops = () => t.page.evaluate(() => npchip.store.breaks.value);
  equal(await stops(), [{ file: MAIN, line: line + 1, condition: "" }], "the breakpoint under a new line");
  await t.chord("Control", "z");
  equal(await stops(), [{ file: MAIN, line, condition: "" }], "the breakpoint after undo");
  await goTo(t, /^frame:/);
  await t.chord("Shift", "F9");
  await t.until("the condition is asked for", () => document.activeElement instanceof HTMLInputElement);
  await t.page.keyboard.type("any nonsense ??");
  await press(t, "Enter");
  await t.until("it is refused", () => document.querySelector("form [role=alert]")?.textContent);
  await t.chord("Control", "a");
  await t.page.keyboard.type("any r0 > 3");
  await press(t, "Enter");
  await t.until("it is set", () => npchip.store.breaks.value[0]?.condition === "any r0 > 3");
  await t.until("the text has the focus again", () => document.activeElement?.getAttribute("aria-label") === "Program");
  await press(t, "F9");
  equal(await stops(), [], "the breakpoints in the end");
});

flow("editor: jump to a definition, to an include, and back", async (t) => {
  await start(t);
  const line = await goTo(t, /^ +centre /);
  await press(t, "ArrowRight", 10);
  await press(t, "F12");
  await t.until("the macro's file is open", (main) => npchip.store.openFile.value !== main, [MAIN] as const);
  const at = await t.page.evaluate(() => npchip.store.cursor.value);
  const lines = (await fileText(t, await openFile(t)))?.split("\n") ?? [];
  check(/^\.macro +centre/.test(lines[(at?.line ?? 0) - 1] ?? ""), "the cursor is not at the macro");
  await t.chord("Alt", "ArrowLeft");
  await t.until("it is back", (name) => npchip.store.openFile.value === name, [MAIN] as const);
  equal(await t.page.evaluate(() => npchip.store.cursor.value), { file: MAIN, line }, "the cursor");
  await goTo(t, /^\.include "lib\/trajectory_common\.s"/);
  await press(t, "F12");
  await t.until("the include is open", () => npchip.store.openFile.value === "lib/trajectory_common.s");
});

flow("editor: completion offers what fits, and a card explains a word", async (t) => {
  await start(t);
  const before = await fileText(t, MAIN);
  const line = await goTo(t, /^ +MOV +known, #1/);
  await press(t, "End");
  await press(t, "Enter");
  await t.page.keyboard.type("JAN");
  await t.until("JANY is offered", () =>
    [...document.querySelectorAll(".cm-completionLabel")].some((each) => each.textContent === "JANY"),
  );
  // Completion takes no key at once, so that nothing is taken by mistake.
  await new Promise((resolve) => setTimeout(resolve, 200));
  await press(t, "Enter");
  await t.until("its operands are there", () =>
    document.querySelector(".cm-content")?.textContent?.includes("JANY  cc, target"),
  );
  await t.page.keyboard.type("L");
  const labels = await t.until("conditions are offered", () => {
    const all = [...document.querySelectorAll(".cm-completionLabel")].map((each) => each.textContent);
    return all.length > 0 && all;
  });
  equal(labels, ["LO", "LS"], "what is offered for a condition");
  await press(t, "Escape");
  await t.chord("Control", "z");
  for (let presses = 0; presses < 10 && (await fileText(t, MAIN)) !== before; presses += 1) {
    await t.chord("Control", "z");
  }
  equal(await fileText(t, MAIN), before, "the program after undo");
  await goTo(t, /^ +MOV +known, #1/);
  await press(t, "ArrowRight", 11);
  await press(t, "F1");
  await tip(t, /MOV · instruction.*MOV rd, rs/s);
  await press(t, "Escape");
  await t.until("the card is closed", () => !document.querySelector(".cm-tooltip"));
  await press(t, "ArrowRight", 6);
  await press(t, "F1");
  await tip(t, /known · register.*Defined in line \d+/s);
  equal(await t.page.evaluate(() => npchip.store.cursor.value?.line), line, "the cursor's line");
});

flow("editor: F8 and the list of mistakes lead to them", async (t) => {
  await start(t);
  const first = await goTo(t, /^frame:/);
  await press(t, "End");
  await press(t, "Enter");
  await t.page.keyboard.type("FOO r1");
  await press(t, "Escape");
  await mistakes(t, "some");
  // The word too many breaks the budget too, further up.
  await goTo(t, /^ +JMP +still/);
  await press(t, "F8");
  await t.until("F8 goes there", (line) => npchip.store.cursor.value?.line === line, [first + 1] as const);
  await goTo(t, /^\.equ THRESHOLD/);
  await t.page.evaluate(() => {
    const all = [...document.querySelectorAll<HTMLElement>('[role="list"][aria-label="Mistakes"] button')];
    all.find((each) => each.textContent?.includes("FOO"))?.click();
  });
  await t.until("the list goes there", (line) => npchip.store.cursor.value?.line === line, [first + 1] as const);
  await t.until("the tab tells", () => /mistake/.test(document.querySelector("[role=tab]")?.textContent ?? ""));
});

flow("editor: each file undoes its own changes", async (t) => {
  await start(t);
  const texts = new Map([[MAIN, ""], ["lib/trajectory_common.s", ""]]);
  for (const name of texts.keys()) {
    texts.set(name, (await fileText(t, name)) ?? "");
    await (await t.control("tab", name)).click();
    await (await t.control("textbox", "Program")).focus();
    await t.page.keyboard.type("; ");
    const before = [name, texts.get(name) ?? ""] as const;
    await t.until("the text has changed", (file, was) => npchip.store.project.value.files[file] !== was, before);
  }
  for (const [name, text] of texts) {
    await (await t.control("tab", name)).click();
    await (await t.control("textbox", "Program")).focus();
    await t.chord("Control", "z");
    const before = [name, text] as const;
    await t.until(`${name} is as it was`, (file, was) => npchip.store.project.value.files[file] === was, before);
  }
});
