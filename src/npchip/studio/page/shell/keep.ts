/** What the browser keeps between visits: the program with its files, and settings. */

import { checked, type Shared } from "./share";

const PROGRAM = "npchip.program";
const ASIDE = "npchip.aside";
const GREETED = "npchip.greeted";
const THEME = "npchip.theme";

/** Keep the program.
 * @throws Error if the browser refuses, or if its storage is full. */
export function keepProgram(shared: Shared): void {
  try {
    localStorage.setItem(PROGRAM, JSON.stringify(shared));
  } catch {
    throw new Error(
      "this browser cannot keep the program (its storage is full or switched off): " +
        "save it as a file before you close the page",
    );
  }
}

/** Return the program that was kept; null if there is none, or if it is damaged. */
export function keptProgram(): Shared | null {
  return kept(PROGRAM);
}

/** Keep a program that gave way to an example. It stays as long as the page if it cannot be kept. */
export function keepAside(shared: Shared): void {
  put(ASIDE, JSON.stringify(shared));
}

export function keptAside(): Shared | null {
  return kept(ASIDE);
}

/** True until the reader has seen what to try first. */
export function isNew(): boolean {
  try {
    return localStorage.getItem(GREETED) === null;
  } catch {
    return true;
  }
}

export function greeted(): void {
  put(GREETED, "yes");
}

/** Keep what is no loss if the browser refuses. */
function put(key: string, text: string): void {
  try {
    localStorage.setItem(key, text);
  } catch {
    // It lasts as long as the page.
  }
}

function kept(key: string): Shared | null {
  try {
    const text = localStorage.getItem(key);
    return text === null ? null : checked(JSON.parse(text));
  } catch {
    return null;
  }
}

export type Theme = "system" | "light" | "dark";

export function keptTheme(): Theme {
  try {
    const kept = localStorage.getItem(THEME);
    return kept === "light" || kept === "dark" ? kept : "system";
  } catch {
    return "system";
  }
}

/** Use a theme now and at the next visits. */
export function useTheme(theme: Theme): void {
  if (theme === "system") delete document.documentElement.dataset["theme"];
  else document.documentElement.dataset["theme"] = theme;
  put(THEME, theme);
}
