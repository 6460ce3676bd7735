/** For everyone: names, sizes, contrast, the keyboard alone, less motion. */

import { check, equal } from "../driver/expect";
import { flow, type Options } from "../driver/flow";
import { focused, misfits, violations } from "../driver/looks";
import type { Session } from "../driver/session";
import { assembling, ended, give, instructions, opened, openExample, still } from "../driver/studio";

/** Each panel, and the dialogs: what axe and the sizes look at. */
const PANELS = ["Array", "Processor", "Cycles", "Checks", "Stops"];
const DIALOGS = ["Save", "Share", "Help", "Draw"];

/** Do something with each view of the page; `part` is what the view brings. */
async function everywhere(t: Session, look: (where: string, part: string) => Promise<void>): Promise<void> {
  for (const panel of PANELS) {
    const tab = await t.control("tab", panel);
    await tab.evaluate((element) => element.click());
    await t.until(`the panel ${panel} is shown`, (e) => e.getAttribute("aria-selected") === "true", [tab] as const);
    await look(`panel ${panel}`, "[role=tabpanel]");
  }
  for (const dialog of DIALOGS) {
    await t.press(dialog);
    await t.until(`the dialog ${dialog} is open`, () => document.querySelector("dialog[open]"));
    await look(`dialog ${dialog}`, "dialog[open]");
    await t.page.keyboard.press("Escape");
    await t.until(`the dialog ${dialog} is closed`, () => !document.querySelector("dialog[open]"));
  }
}

async function axe(t: Session): Promise<void> {
  await opened(t);
  await assembling(t);
  await ended(t);
  const found = await violations(t);
  // The rest of the page is the same in all views.
  await everywhere(t, async (where, part) => {
    found.push(...(await violations(t, part)).map((each) => `${where}: ${each}`));
  });
  equal(found, [], "what axe finds");
}

async function sizes(t: Session): Promise<void> {
  await opened(t);
  await assembling(t);
  await ended(t);
  const found = new Set<string>();
  await everywhere(t, async () => {
    for (const each of await misfits(t)) found.add(each);
  });
  equal([...found], [], "what is too small or too wide");
}

const PHONE: Options = { width: 360, height: 740 };
flow("access: axe, light", axe, { theme: "light", seconds: 150 });
flow("access: axe, dark", axe, { theme: "dark", seconds: 150 });
flow("access: axe, light, on a phone", axe, { ...PHONE, theme: "light", seconds: 150 });
flow("access: axe, dark, on a phone", axe, { ...PHONE, theme: "dark", seconds: 150 });
flow("access: sizes", sizes, { seconds: 150 });
flow("access: sizes on a phone", sizes, { ...PHONE, seconds: 150 });
// 1280 × 720 at 200 %: the page gets half of it.
flow("access: sizes at 200 %", sizes, { width: 640, height: 360, seconds: 150 });

flow("access: text of twice the size is not cut", async (t) => {
  await opened(t);
  await ended(t);
  await t.page.evaluate(() => {
    document.documentElement.style.fontSize = "200%";
  });
  const cut = await t.page.evaluate(() =>
    [...document.querySelectorAll<HTMLElement>("button, [role=tab], label > span, h2, [role=status]")]
      .filter((element) => element.checkVisibility())
      // Some names are for screen readers only.
      .filter((element) => element.getBoundingClientRect().width > 1)
      .filter((element) => {
        const style = getComputedStyle(element);
        const hides = style.overflowX !== "visible" || style.overflowY !== "visible";
        return hides && (element.scrollWidth > element.clientWidth + 1 || element.scrollHeight > element.clientHeight + 1);
      })
      .map((element) => (element.textContent ?? "").trim().slice(0, 40)),
  );
  equal(cut, [], "texts that are cut");
});

flow(
  "access: nothing moves by itself where the reader asks for no motion",
  async (t) => {
    await t.open();
    await assembling(t);
    await t.control("button", "Run");
    await t.until("a program is there", () => npchip.store.program.value !== null);
    const before = await instructions(t);
    const moves = await t.page.evaluate(async () => {
      for (let count = 0; count < 60; count += 1) await new Promise(requestAnimationFrame);
      return document
        .getAnimations()
        .filter((each) => each.playState === "running")
        .map((each) => (each as CSSAnimation).animationName ?? (each as CSSTransition).transitionProperty);
    });
    // A caret may blink.
    equal(moves.filter((name) => !/blink/.test(name)), [], "animations");
    equal(await instructions(t), before, "instructions");
    equal(await t.page.evaluate(() => npchip.store.running.value), false, "whether it runs");
    await t.press("Run");
    await t.until("it runs when it is asked to", () => npchip.store.frameCount.value > 0);
  },
  { still: true },
);

/** Press Tab, after Escape where Tab writes, and return what has the focus then. */
async function tab(t: Session, back = false): ReturnType<typeof focused> {
  if ((await focused(t))?.editor) await t.page.keyboard.press("Escape");
  await (back ? t.chord("Shift", "Tab") : t.page.keyboard.press("Tab"));
  const end = Date.now() + 1000;
  // An editor shows its focus a moment later.
  for (;;) {
    const now = await focused(t);
    if (!now || now.visible) return now;
    check(Date.now() < end, `the focus on ${now.role} '${now.name}' cannot be seen`);
  }
}

/** Press Tab, or Shift and Tab to go back, until a control has the focus. */
async function tabTo(t: Session, name: string, back = false): Promise<void> {
  let now = await focused(t);
  for (let presses = 0; presses < 120; presses += 1) {
    if (now?.name === name) return;
    now = await tab(t, back);
  }
  throw new Error(`Tab does not reach '${name}'`);
}

flow("access: Tab goes once through the page", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await assembling(t);
  // All that Tab reaches, once through: each can be seen to have the focus.
  const reached: string[] = [];
  for (let presses = 0; presses < 120; presses += 1) {
    const now = await tab(t);
    if (!now) break;
    if (reached.length > 5 && now.name === reached[0]) break;
    check(now.inside, `the focus on ${now.role} '${now.name}' is outside of what is shown`);
    reached.push(now.name);
  }
  const order = ["Example", "Clip", "Machine", "Run", "Reset", "Program"];
  const places = order.map((name) => reached.indexOf(name));
  check(places.every((place) => place >= 0), `Tab reaches ${reached.join(", ")}, not all of ${order.join(", ")}`);
  equal([...places].sort((a, b) => a - b), places, "the order in which Tab reaches them");
});

flow("access: arrow keys look through a box and open nothing", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await assembling(t);
  const main = () => t.page.evaluate(() => npchip.store.project.value.main);
  const box = await t.control("combobox", "Example");
  await box.focus();
  await t.page.keyboard.press("ArrowDown");
  await t.message(/Press Enter/);
  equal(await main(), "trajectory.s", "the program after an arrow key");
  await t.page.keyboard.press("Escape");
  equal(await box.evaluate((element) => (element as HTMLSelectElement).value), "trajectory", "the box after Escape");
  await t.page.keyboard.press("ArrowDown");
  await t.page.keyboard.press("Enter");
  await t.until("the next example is open", () => npchip.store.project.value.main !== "trajectory.s");
});

flow("access: a problem stays until it is dismissed", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await assembling(t);
  await give(t, "Open", [t.axe]); // no source, no clip
  await t.message(/Problem/);
  await t.page.evaluate(() => {
    npchip.store.message.value = { kind: "info", text: "said later" };
  });
  check(/Problem/.test(await t.message(/said later/)), "what is said later hides the problem");
  await t.press("Dismiss the problem");
  await t.until("the problem is gone", () => !document.querySelector("[aria-label=Messages] [role=alert]"));
});

flow("access: a scene is drawn by keyboard, and there again after a reload", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await t.press("Draw");
  await t.until("the canvas is there", () => document.querySelector("dialog[open] canvas[tabindex]"));
  await t.page.focus("dialog[open] canvas[tabindex]");
  await t.page.keyboard.press("ArrowRight");
  await t.page.keyboard.press(" ");
  await t.press("Use this scene");
  const lit = await t.until("the scene is the clip", () => {
    const { value } = npchip.store.clip;
    if (!value || value === "live" || value.name !== "drawn scene") return 0;
    return value.data.filter((grey) => grey === 230).length;
  });
  check(lit > 20, `${lit} pixels are drawn in 30 frames`);
  await t.page.reload();
  await t.until("the scene is the clip again", () => {
    const { value } = npchip.store.clip;
    return value && value !== "live" && value.name === "drawn scene";
  });
  await t.press("Draw");
  await t.press("Clear drawing");
  await t.press("Undo");
  await t.press("Use this scene");
  const again = await t.page.evaluate(() => {
    const { value } = npchip.store.clip;
    return value && value !== "live" ? value.data.filter((grey) => grey === 230).length : 0;
  });
  equal(again, lit, "pixels of the scene after Clear drawing and Undo");
});

flow("access: the keyboard alone", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await assembling(t);
  // Write in the editor, and leave it.
  await tabTo(t, "Program");
  await t.chord("Control", "Home");
  await t.page.keyboard.type("; by keyboard\n");
  await t.until("the text is in the program", () => {
    const { main, files } = npchip.store.project.value;
    return files[main]?.startsWith("; by keyboard\n");
  });
  await t.page.keyboard.press("Escape");
  await t.page.keyboard.press("Tab");
  check(!(await focused(t))?.editor, "Escape and Tab do not leave the editor");

  // Run to the end, reset, step.
  await tabTo(t, "Run", true);
  await t.page.keyboard.press("Enter");
  await ended(t);
  await tabTo(t, "Reset");
  await t.page.keyboard.press(" ");
  await t.until("the chip is reset", () => npchip.store.view.value?.instructions === 0);
  await tabTo(t, "Step");
  await t.page.keyboard.press("Enter");
  await t.until("a step is done", () => npchip.store.view.value?.instructions === 1);
  await still(t);

  // Choose an NP with the arrows.
  const grid = await t.page.waitForSelector("[aria-label=Array] [tabindex='0']:is([role=gridcell], [role=grid], canvas, button)");
  check(grid, "no NP can have the focus");
  await grid.focus();
  const before = await t.page.evaluate(() => npchip.store.chosen.value);
  await t.page.keyboard.press(before.column < 9 ? "ArrowRight" : "ArrowLeft");
  await t.page.keyboard.press("Enter");
  await t.until(
    "another NP is chosen",
    (was) => npchip.store.chosen.value.column !== was,
    [before.column] as const,
  );
});
