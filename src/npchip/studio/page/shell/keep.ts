/** Storage in the browser between visits: the program with its files, and settings. */

import { checked, type Shared } from "./share";

const PROGRAM = "npchip.program";
const ASIDES = "npchip.asides";
const DAMAGED = "npchip.damaged";
const DRAWING = "npchip.drawing";
const GREETED = "npchip.greeted";
const THEME = "npchip.theme";

/** Names this tab, as long as it is open. */
const TAB = Math.random().toString(36).slice(2);
/** The program that this tab kept or read last; another one there is from another tab. */
let own: string | null = null;

/** A program that another tab has kept, and that this tab's program replaces. */
export interface Foreign {
  shared: Shared;
  /** Names the other tab. */
  tab: string;
}

/** Return what another tab has kept since this one did; null if there is nothing. */
export function foreignProgram(): Foreign | null {
  const text = stored(PROGRAM);
  if (text === null) return null;
  try {
    const found: unknown = JSON.parse(text);
    const shared = checked(found);
    return JSON.stringify(shared) === own ? null : { shared, tab: String(Object(found).tab) };
  } catch {
    return null; // a later visit sets it apart
  }
}

/** Keep the program.
 * @throws Error if the browser refuses, or if its storage is full. */
export function keepProgram(shared: Shared): void {
  try {
    localStorage.setItem(PROGRAM, JSON.stringify({ ...shared, tab: TAB }));
    own = JSON.stringify(checked(shared));
  } catch {
    throw new Error(
      "this browser cannot keep the program (its storage is full or switched off): " +
        "save it as a file before you close the page",
    );
  }
}

/** Return the program that was kept; null if there is none.
 * @throws Error if it cannot be read. Its text is set aside then, as the next one takes its place. */
export function keptProgram(): Shared | null {
  const text = stored(PROGRAM);
  if (text === null) return null;
  try {
    const found = checked(JSON.parse(text));
    own = JSON.stringify(found);
    return found;
  } catch {
    put(DAMAGED, text);
    throw new Error("The program kept in this browser cannot be read: press Save to download it as it is");
  }
}

/** The text of a kept program that could not be read; null if there is none. */
export function damagedText(): string | null {
  return stored(DAMAGED);
}

/** A program that gave way to another one, and when. */
export interface Aside {
  at: number;
  shared: Shared;
  /** The other tab that it comes from: its next one takes this one's place. */
  tab?: string;
}

/** Keep the programs set aside. They stay as long as the page if they cannot be kept. */
export function keepAsides(all: Aside[]): void {
  put(ASIDES, JSON.stringify(all));
}

export function keptAsides(): Aside[] {
  try {
    const found: unknown = JSON.parse(stored(ASIDES) ?? "[]");
    if (!Array.isArray(found)) return [];
    return found.map(({ at, shared, tab }: Aside) => ({
      at: Number(at),
      shared: checked(shared),
      ...(tab === undefined ? {} : { tab: String(tab) }),
    }));
  } catch {
    return [];
  }
}

/** Call `then` when another tab has set programs aside. */
export function onAsides(then: () => void): void {
  window.addEventListener("storage", ({ key }) => {
    if (key === ASIDES) then();
  });
}

/** Keep the scene that was drawn. It stays as long as the page if it cannot be kept. */
export function keepDrawing(text: string): void {
  put(DRAWING, text);
}

export function keptDrawing(): string | null {
  return stored(DRAWING);
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

function stored(key: string): string | null {
  try {
    return localStorage.getItem(key);
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
