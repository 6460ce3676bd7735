/** Find a control of the page by its role and name. */

import type { ElementHandle, Page } from "puppeteer-core";
import type { Kind } from "./flow";

/** Elements that have a role without saying so. */
const NATIVE: Record<string, string> = {
  button: "button, summary",
  combobox: "select",
  region: "section",
  table: "table",
  textbox: "textarea, input:not([type]), input[type=text]",
};

/**
 * Wait for a control that can be seen.
 *
 * Chromium computes role and name itself, as a screen reader gets them. Firefox would have to start
 * its accessibility service, which makes the whole page ten times as slow: there the document is
 * searched, whose names Chromium has checked.
 */
export async function named(
  page: Page,
  kind: Kind,
  role: string,
  name: string,
  timeout: number,
): Promise<ElementHandle<HTMLElement> | null> {
  if (kind === "chromium") {
    const selector = `aria/${name}[role="${role}"]`;
    return (await page.waitForSelector(selector, { visible: true, timeout })) as ElementHandle<HTMLElement> | null;
  }
  const selector = [`[role="${role}"]`, ...(NATIVE[role] ?? "").split(", ").filter(Boolean)]
    .map((each) => (each.startsWith("[") ? each : `${each}:not([role])`))
    .join();
  const found = await page.waitForFunction(search, { timeout, polling: 50 }, selector, name);
  return found.asElement() as ElementHandle<HTMLElement> | null;
}

/** The first element that can be seen and has a name. It runs in the page, so it calls nothing else. */
function search(selector: string, name: string): HTMLElement | undefined {
  const plain = (text: string | null | undefined) => (text ?? "").replace(/\s+/g, " ").trim();
  const said = (element: Element): string => {
    const copy = element.cloneNode(true) as Element;
    for (const hidden of copy.querySelectorAll("[aria-hidden=true], select, textarea")) hidden.remove();
    return plain(copy.textContent);
  };
  const nameOf = (element: HTMLElement): string => {
    const by = element.getAttribute("aria-labelledby")?.split(" ") ?? [];
    const others = by.map((id) => document.getElementById(id)).filter((each) => each !== null);
    if (others.length > 0) return plain(others.map(said).join(" "));
    const label = element.getAttribute("aria-label");
    if (label) return plain(label);
    const [owner] = (element as HTMLInputElement).labels ?? [];
    return owner ? said(owner) : said(element);
  };
  return [...document.querySelectorAll<HTMLElement>(selector)].find((element) => {
    const { width, height } = element.getBoundingClientRect();
    const shown = width > 0 && height > 0 && element.checkVisibility({ visibilityProperty: true });
    return shown && nameOf(element) === name;
  });
}
