/** Flows: what a reader does in the page, and what must come of it. */

import type { Session } from "./session";

export type Kind = "chromium" | "firefox";

export interface Options {
  theme?: "light" | "dark";
  /** True for a reader who asks for no motion. */
  still?: boolean;
  width?: number;
  height?: number;
  /** Seconds until the flow is given up. */
  seconds?: number;
  /** True for a reader who was never here: nothing is in the browser's caches. */
  fresh?: boolean;
}

export interface Flow extends Options {
  run: (t: Session) => Promise<void>;
}

/** All flows by name. */
export const flows = new Map<string, Flow>();

/** Add a flow. The tests find its name in the text of the file, so it stands behind the bracket. */
export function flow(name: string, run: (t: Session) => Promise<void>, options: Options = {}): void {
  if (flows.has(name)) throw new Error(`two flows are called '${name}'`);
  flows.set(name, { ...options, run });
}
