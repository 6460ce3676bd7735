/** A reader's first quarter of an hour: a mistake, its fix, a breakpoint, a step back, the array. */

import puppeteer, { type Frame } from "puppeteer-core";
import { Window } from "./window";

const given = JSON.parse(process.argv[2] ?? "{}") as Record<string, string>;

const browser = await puppeteer.launch({
  browser: "chrome",
  executablePath: given["browser"] ?? "",
  headless: true,
  args: [
    ...(process.getuid?.() === 0 ? ["--no-sandbox"] : []),
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
    "--disable-dev-shm-usage",
  ],
  defaultViewport: { width: 1600, height: 1000 },
});
const window = new Window(await browser.newPage(), given);
try {
  await flow(window);
} catch (error) {
  await window.picture("failed").catch(() => undefined);
  throw error;
} finally {
  await browser.close();
}

async function flow(w: Window): Promise<void> {
  const report: Record<string, unknown> = {};
  await w.open(w.parameter("url"), w.parameter("work"));
  // VS Code ticks off only what happens after it has shown the walkthrough.
  await guide(w);
  await w.show("darker.s");
  // Hints of words and cycles stand beside a line as soon as the server has read the program.
  await w.sees(".view-line [class*=dyn-rule]", "a hint beside a line");
  await w.picture("open");

  await w.at(10, 9);
  await w.keys("Control+Shift+ArrowRight");
  await w.type("SHRR");
  await w.sees(".squiggly-error", "the mistake");
  await w.command("Problems: Focus on Problems View");
  report["mistake"] = await w.sees(".markers-panel .monaco-list-row [class*=marker]", "the problem", "SHRR");
  await w.picture("mistake");

  await w.command("View: Focus Active Editor Group");
  await w.command("Quick Fix...");
  await w.sees(".action-widget .monaco-list-row", "the fix", "SHR");
  await w.picture("fix");
  await w.keys("Enter");
  await w.lacks(".squiggly-error", "the mistake");
  await w.keys("Control+s");
  report["line"] = await w.sees(".view-line", "the line without the mistake", "SHR     r1, #1");
  await w.picture("fixed");

  await w.command("Tasks: Run Build Task");
  await w.sees(".terminal-tab, .terminal-tabs-entry, .single-terminal-tab", "the task");
  await w.command("View: Toggle Panel Visibility");
  await w.at(12);
  await w.keys("F9");
  await w.sees(".codicon-debug-breakpoint", "the breakpoint");
  await w.keys("F5");
  await w.answer(w.parameter("frames"));
  await w.stopsAt(6);
  await w.command("View: Show Run and Debug");
  const array = await w.inside(".array-np", "the array");
  report["processors"] = await array.$$eval(".array-np", (all) => all.length);
  await w.picture("entry");

  await w.command("Debug: Continue");
  await w.stopsAt(12);
  const pixel = await register(array, 1, (value) => value > 0);
  report["halved"] = pixel;
  report["variables"] = await w.sees(".debug-variables .monaco-list-row", "the variable r1", "r1");
  await w.picture("breakpoint");

  await w.press("Step Back");
  await w.stopsAt(11);
  await w.press("Step Back");
  await w.stopsAt(10);
  report["whole"] = await register(array, 1, (value, before) => value !== before, pixel);
  await w.sees(".debug-variables .monaco-list-row", "the variable as it was", `r1 = ${String(report["whole"])}`);
  await w.picture("back");

  await array.click(".array-np[aria-colindex='6']");
  await w.sees(".debug-variables .monaco-list-row", "the variables of the NP that was chosen", "NP (0,5)");
  await array.click(".array-registers tbody tr:nth-child(2) button");
  await array.waitForSelector(".array-menu button");
  await array.click(".array-menu button");
  report["who"] = await w.until(
    "the panel says who wrote a value",
    () => document.querySelector(".panel-said")?.textContent,
    [],
    array,
  );
  await array.click(".array-registers tbody tr:nth-child(2) button");
  await array.waitForSelector(".array-menu button");
  await array.click(".array-menu button:nth-of-type(2)");
  await w.sees(".debug-breakpoints .monaco-list-row", "the condition among the breakpoints", "np(0,5).r1 changes");
  await w.command("Debug: Continue");
  await w.stopsAt(11);
  await array.select("select", "bank:0");
  await w.picture("bank");
  report["notices"] = await w.page.$$eval(".notifications-toasts .notification-list-item-message", (all) =>
    all.map((item) => item.textContent),
  );
  await w.command("Preferences: Toggle between Light/Dark Themes");
  await w.sees(".monaco-workbench.vs-dark", "the dark theme");
  await w.picture("dark");

  await w.press("Stop");
  await w.lacks(".debug-top-stack-frame-line", "the mark of the next line");
  await guide(w);
  report["done"] = await w.page.$$eval(".getting-started-step [role=checkbox][aria-checked=true]", (all) =>
    all.map((box) => box.getAttribute("data-done-step-id")?.split("#").at(-1)),
  );
  await w.picture("walkthrough");

  console.log(JSON.stringify(report));
}

async function guide(w: Window): Promise<void> {
  await w.asking("Welcome: Open Walkthrough...", "Get started with npchip");
  await w.sees(".getting-started-step", "the steps of the walkthrough", "See the array");
}

/** Wait until a register of the NP that the array shows has a value that will do, and return it. */
async function register(
  array: Frame,
  number: number,
  fits: (value: number, before: number) => boolean,
  before = 0,
): Promise<number> {
  const row = number + 1;
  for (let tries = 0; tries < 300; tries++) {
    const text = await array.$eval(`.array-registers tbody tr:nth-child(${row}) td`, (cell) => cell.textContent);
    if (fits(Number(text), before)) return Number(text);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  throw new Error(`waited in vain until r${number} has another value than ${before}`);
}
