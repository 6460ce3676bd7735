/** What the browser keeps between visits: the program with its files, and settings. */

import { checked, type Shared } from "./share";

const PROGRAM = "npchip.program";
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
  try {
    const text = localStorage.getItem(PROGRAM);
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
  try {
    localStorage.setItem(THEME, theme);
  } catch {
    // It lasts as long as the page.
  }
}
