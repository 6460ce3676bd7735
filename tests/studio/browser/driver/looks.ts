/** How a page looks to readers who need more than eyes and a mouse. */

import { readFile } from "node:fs/promises";
import type { Session } from "./session";

interface AxeNode {
  target: string[];
  failureSummary: string;
}
interface Axe {
  run(scope: string, options: object): Promise<{ violations: { id: string; help: string; nodes: AxeNode[] }[] }>;
}

/** What axe finds wrong with the page as it is now, or with a part of it. */
export async function violations(t: Session, scope = "html"): Promise<string[]> {
  await t.page.evaluate(await readFile(t.axe, "utf8"));
  return t.page.evaluate(async (selector) => {
    const { axe } = globalThis as unknown as { axe: Axe };
    const all = await axe.run(selector, { resultTypes: ["violations"] });
    return all.violations.map(({ id, help, nodes }) => {
      const places = nodes.slice(0, 4).map((node) => `${node.target.join(" ")}: ${node.failureSummary}`);
      return `${id} (${help}), ${nodes.length} times, as ${places.join(" | ")}`;
    });
  }, scope);
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
    const count = new Map<string, number>();
    for (const element of document.querySelectorAll<HTMLElement>(CONTROLS)) {
      if (!shown(element) || element.closest("p a, .shell-skip")) continue;
      const small = element.matches("[type=radio], [type=checkbox]");
      const target = (small && element.closest("label")) || element;
      const { width, height } = target.getBoundingClientRect();
      if (Math.min(width, height) < 23.9) {
        const name = (element.getAttribute("aria-label") ?? element.innerText).trim().slice(0, 40);
        const size = `${width.toFixed(1)} × ${height.toFixed(1)}`;
        const place = [element.parentElement?.parentElement, element.parentElement, element]
          .map((each) => `${each?.localName}.${each?.className}`)
          .join(" > ");
        count.set(place, (count.get(place) ?? 0) + 1);
        if (count.get(place) === 1) wrong.push(`'${name}' is ${size}: ${place}`);
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
    const outlined = (each: Element): boolean => {
      const { outlineStyle, outlineWidth } = getComputedStyle(each);
      return outlineStyle !== "none" && Number.parseFloat(outlineWidth) >= 1;
    };
    // What holds an editor may have the ring.
    let visible = getComputedStyle(element).boxShadow !== "none";
    let each: Element | null = element;
    for (let up = 0; each && up < 6; up += 1, each = each.parentElement) visible ||= outlined(each);
    const box = element.getBoundingClientRect();
    const inside = box.bottom > 0 && box.top < innerHeight && box.right > 0 && box.left < innerWidth;
    return {
      name: name.trim().slice(0, 60),
      role: element.getAttribute("role") ?? element.tagName.toLowerCase(),
      editor: element.closest(".cm-editor") !== null,
      visible,
      inside,
    };
  });
}

