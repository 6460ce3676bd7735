/** A page with the panels alone, which uses itself as a reader would and writes down what it found. */

import axe from "axe-core";
import { render } from "preact";
import { provide } from "../../../src/npchip/studio/page/actions";
import { ArrayView } from "../../../src/npchip/studio/page/array/ArrayView";
import { Breaks } from "../../../src/npchip/studio/page/array/Breaks";
import { Processor } from "../../../src/npchip/studio/page/array/Processor";
import { Travel } from "../../../src/npchip/studio/page/array/Travel";
import type { ChipView, ProgramInfo } from "../../../src/npchip/studio/page/protocol";
import * as store from "../../../src/npchip/studio/page/store";

/** What Python has put into the page. */
declare const DATA: { program: ProgramInfo; views: Record<string, unknown>[] };

const views = DATA.views.map((view) => {
  const bytes = Object.entries(view).map(([key, value]) => {
    const plane = Array.isArray(value) && key !== "stack" && key !== "masks";
    if (key === "masks") return [key, (value as number[][]).map((mask) => Uint8Array.from(mask))];
    return [key, plane ? Uint8Array.from(value as number[]) : value];
  });
  return Object.fromEntries(bytes) as ChipView;
});

/** What the panels asked for, and what was found. */
const asked: unknown[] = [];
const found: Record<string, unknown> = {};

const unused = (): void => undefined;
provide({
  edit: unused,
  setProject: unused,
  run: unused,
  pause: unused,
  reset: unused,
  check: unused,
  save: unused,
  showFrame: unused,
  profile: () => Promise.resolve(new Float64Array()),
  show: (...place) => void asked.push(["show", ...place]),
  go: (travel, back = false) => void asked.push(["go", travel, back]),
  async goToLine(file, line, back) {
    asked.push(["go", { to: "cursor", file, line }, back]);
    return null;
  },
  whoWrote: (value) => void asked.push(["who", value]),
  choose(row, column) {
    store.chosen.value = { row, column };
  },
  showCell(cell) {
    store.shownCell.value = cell;
  },
  toggleBreak(file, line) {
    store.breaks.value = store.breaks.value.filter((each) => each.file !== file || each.line !== line);
  },
  setBreakCondition: () => Promise.resolve("no such condition"),
  addCondition(text) {
    if (text.startsWith("wrong")) return Promise.resolve("error[NP351]: no register 'wrong'");
    store.conditions.value = [...store.conditions.value, text];
    return Promise.resolve(null);
  },
  removeCondition(text) {
    store.conditions.value = store.conditions.value.filter((each) => each !== text);
  },
  enableBreak(key, on) {
    asked.push(["enable", key, on]);
  },
});

const pause = (): Promise<unknown> => new Promise((done) => setTimeout(done, 30));

function one(selector: string): HTMLElement {
  const element = document.querySelector<HTMLElement>(selector);
  if (!element) throw new Error(`nothing is ${selector}`);
  return element;
}

const named = (name: string): HTMLElement => one(`[aria-label="${name}"]`);
const focused = (): string =>
  document.activeElement?.getAttribute("aria-label") ?? document.activeElement?.textContent ?? "";

async function press(key: string, more: KeyboardEventInit = {}): Promise<void> {
  const event = new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true, ...more });
  const goesOn = (document.activeElement ?? document.body).dispatchEvent(event);
  // As a browser does it for a button.
  if (goesOn && key === "Enter") (document.activeElement as HTMLElement).click();
  await pause();
}

async function type(element: HTMLElement, text: string): Promise<void> {
  const input = element as HTMLInputElement;
  input.focus();
  input.value = text;
  input.dispatchEvent(new Event("input", { bubbles: true }));
  input.dispatchEvent(new Event("change", { bubbles: true }));
  await pause();
}

async function look(at: number): Promise<void> {
  store.view.value = views[at] ?? null;
  await pause();
}

async function array(): Promise<void> {
  found.cells = [...document.querySelectorAll(".array-np")].map((np) => np.getAttribute("aria-label"));
  one('.array-np[tabindex="0"]').focus();
  await press("ArrowDown");
  await press("ArrowRight");
  found.focused = focused();
  await press("Enter");
  found.chosen = { ...store.chosen.value };
  one('[data-row="2"][data-column="3"]').click();
  await pause();
  found.clicked = { ...store.chosen.value };
  found.stops = document.querySelectorAll('.array-grid [tabindex="0"]').length;
  found.heading = one(".array-heading h2").textContent;
}

async function arrows(): Promise<void> {
  await look(1);
  found.none = document.querySelectorAll(".array-arrows path").length;
  await look(2);
  found.arrows = document.querySelectorAll(".array-arrows path").length;
  found.values = [...document.querySelectorAll(".array-arrows text")].map((text) => text.textContent);
  found.legend = one(".array-moving").textContent;
  found.changed = [...document.querySelectorAll(".array-registers tr.array-changed button")].map(
    (button) => button.textContent,
  );
}

async function menu(): Promise<void> {
  one('.array-registers [data-item="0"]').focus();
  await press("ArrowDown");
  await press("Enter");
  found.menu = focused();
  await press("ArrowDown");
  dispatchEvent(new Event("scroll"));
  dispatchEvent(new Event("resize"));
  await pause();
  found.second = focused();
  await press("Escape");
  found.left = focused();
  await press("Enter");
  await press("Enter");
  await press("Enter");
  await press("ArrowDown");
  await press("Enter");
  found.conditions = [...store.conditions.value];
}

async function chooser(): Promise<void> {
  const select = one(".array-chooser select") as HTMLSelectElement;
  for (const value of ["bank:128", "memory:"]) {
    select.value = value;
    select.dispatchEvent(new Event("change", { bubbles: true }));
    await pause();
    found[value] = one(".array-grid").getAttribute("aria-label");
  }
  await type(one(".array-address input"), "999");
  found.outside = one("#array-address-wrong").textContent;
  await type(one(".array-address input"), "PLACE");
  found.byName = store.shownCell.value;
}

async function breaks(): Promise<void> {
  store.breaks.value = [{ file: "test.s", line: 3, condition: "" }];
  await pause();
  named("Stop at test.s:3").click();
  await type(named("Condition of test.s:3"), "any r0 > 1");
  found.refused = one(".array-entry .array-wrong").textContent;
  named("Remove test.s:3").click();
  await type(one(".array-new input"), "wrong > 1");
  one(".array-new button").click();
  await pause();
  found.wrong = one(".array-new .array-wrong").textContent;
  await type(one(".array-new input"), "any r0 > 1");
  one(".array-new button").click();
  await pause();
  found.all = [...store.conditions.value];
}

async function steps(): Promise<void> {
  named("Step over, back").click();
  named("To cursor").click();
  await pause();
  found.obstacle = one(".array-travel .array-wrong").textContent;
  store.cursor.value = { file: "test.s", line: 4 };
  named("To cursor").click();
  await press("F11", { ctrlKey: true });
  named("Step").focus();
  await press("f");
  store.running.value = true;
  await press("F11");
  store.running.value = false;
  one(".array-new input").focus();
  await press("f");
  await pause();
}

async function violations(): Promise<string[]> {
  const result = await axe.run(document, { rules: { "page-has-heading-one": { enabled: false } } });
  return result.violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target).join(" ")}`);
}

async function walk(): Promise<void> {
  store.program.value = DATA.program;
  await look(0);
  render(
    <main>
      <ArrayView />
      <Travel />
      <Processor />
      <Breaks />
    </main>,
    document.body,
  );
  await pause();
  for (const part of [array, arrows, menu, chooser, breaks, steps]) await part();
  found.asked = asked;
  for (const theme of ["light", "dark"]) {
    document.documentElement.dataset.theme = theme;
    found[theme] = await violations();
  }
}

walk()
  .catch((fault: unknown) => {
    found.fault = String(fault);
  })
  .finally(() => {
    document.body.textContent = "";
    const result = document.createElement("pre");
    result.textContent = JSON.stringify(found);
    document.body.append(result);
  });
