/** How a page looks to readers who need more than eyes and a mouse. */

import { readFile } from "node:fs/promises";
import type { Session } from "./session";

interface AxeNode {
  target: string[];
  failureSummary: string;
}
interface Axe {
  run(options: object): Promise<{ violations: { id: string; help: string; nodes: AxeNode[] }[] }>;
}

/** What axe finds wrong with the page as it is now. */
export async function violations(t: Session): Promise<string[]> {
  await t.page.evaluate(await readFile(t.axe, "utf8"));
  return t.page.evaluate(async () => {
    const { axe } = globalThis as unknown as { axe: Axe };
    const all = await axe.run({ resultTypes: ["violations"] });
    return all.violations.map(({ id, help, nodes }) => {
      const places = nodes.slice(0, 4).map((node) => `${node.target.join(" ")}: ${node.failureSummary}`);
      return `${id} (${help}), ${nodes.length} times, as ${places.join(" | ")}`;
    });
  });
}

/** Controls of less than 24 × 24 pixels, but for links in a text; and what makes the page too wide. */
export function misfits(t: Session): Promise<string[]> {
  return t.page.evaluate(() => {
    const CONTROLS = [
      ...["a[href]", "button", "input:not([type=hidden])", "select", "summary", "textarea"],
      ...["button", "checkbox", "gridcell", "menuitem", "radio", "slider", "tab"].map((role) => `[role=${role}]`),
    ].join();
    const shown = (element: Element) =>
      element.checkVisibility({ visibilityProperty: true, opacityProperty: true });
    const wrong: string[] = [];
    for (const element of document.querySelectorAll<HTMLElement>(CONTROLS)) {
      if (!shown(element) || element.closest("p a, .shell-skip")) continue;
      const small = element.matches("[type=radio], [type=checkbox]");
      const target = (small && element.closest("label")) || element;
      const { width, height } = target.getBoundingClientRect();
      if (Math.min(width, height) < 23.9) {
        const name = (element.getAttribute("aria-label") ?? element.innerText).trim().slice(0, 40);
        const size = `${width.toFixed(1)} × ${height.toFixed(1)}`;
        wrong.push(`${element.localName} '${name}' of ${element.className || "no class"} is ${size}`);
      }
    }
    const root = document.scrollingElement;
    if (root && root.scrollWidth > innerWidth) {
      const wide = [...document.querySelectorAll("body *")].filter(
        (element) => shown(element) && element.getBoundingClientRect().right > innerWidth + 1,
      );
      const names = wide.slice(0, 5).map((element) => `${element.localName}.${element.className}`);
      wrong.push(`the page is ${root.scrollWidth} wide in ${innerWidth}, by ${names.join(", ")}`);
    }
    return wrong;
  });
}

/** Name and role of what has the focus, and whether that can be seen. */
export function focused(t: Session) {
  return t.page.evaluate(() => {
    const element = document.activeElement as HTMLElement | null;
    if (!element || element === document.body) return null;
    const labels = (element as HTMLInputElement).labels;
    const name =
      element.getAttribute("aria-label") ??
      labels?.[0]?.querySelector("span")?.textContent ??
      labels?.[0]?.textContent ??
      element.textContent ??
      "";
    const ring = (each: Element | null): boolean => {
      if (!each) return false;
      const style = getComputedStyle(each);
      return (style.outlineStyle !== "none" && Number.parseFloat(style.outlineWidth) >= 1) || style.boxShadow !== "none";
    };
    const box = element.getBoundingClientRect();
    const inside = box.bottom > 0 && box.top < innerHeight && box.right > 0 && box.left < innerWidth;
    return {
      name: name.trim().slice(0, 60),
      role: element.getAttribute("role") ?? element.tagName.toLowerCase(),
      editor: element.closest(".cm-editor") !== null,
      visible: ring(element) || ring(element.closest(".cm-editor")) || ring(element.parentElement),
      inside,
    };
  });
}

