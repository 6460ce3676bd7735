/** The ways to travel, with their keys. */

import { signal } from "@preact/signals";
import { act } from "../actions";
import type { Travel } from "../protocol";
import { heard } from "../say";
import { cursor } from "../store";

/** A way to travel: its button, and the keys that do the same. */
export interface Way {
  /** Name of the button. */
  name: string;
  /** Text on the button, a part of the name; empty for an arrow alone beside its other direction. */
  short: string;
  /** One line for the tooltip and the help page. */
  does: string;
  /** The key that works everywhere in the page; null if there is none. */
  key: string | null;
  /** The letter that works while the array, the processor or these buttons have the focus. */
  letter: string;
  back: boolean;
  to: Travel["to"];
}

/** Words that do, beside the button for a step. */
const SHORT: Record<string, string> = {
  "Step back": "Step back",
  "Step over": "Over",
  "Step out": "Out",
  "To next frame": "Frame",
  "Run back": "Run back",
};

/**
 * Ctrl turns a key back, as desktops take Alt with F7 and F10 for their windows, and browsers
 * Shift with F10 for the context menu. F8 and F9 belong to the editor. The letters are those of
 * `npchip debug`. The pictures have a button `Next frame` too, so here it is `To next frame`.
 */
export const shortcuts: readonly Way[] = [
  way("Step", "F11", "s", "step", "Execute one instruction"),
  way("Step back", "Ctrl+F11", "S", "step", "Take back one instruction"),
  way("Step over", "F10", "n", "over", "Execute one instruction, a call with its whole routine"),
  way("Step over, back", "Ctrl+F10", "N", "over", "Take back one instruction, a call with its whole routine"),
  way("Step out", "Shift+F11", "o", "out", "Run until the routine returns"),
  way("Step out, back", "Ctrl+Shift+F11", "O", "out", "Go back to where the routine was called"),
  way("To cursor", "F2", "c", "cursor", "Run to the editor's line"),
  way("To cursor, back", "Ctrl+F2", "C", "cursor", "Go back to the last time this line ran"),
  way("To next frame", "F7", "f", "frame", "Run until the next frame is exposed"),
  way("Frame back", "Ctrl+F7", "F", "frame", "Go back to where this frame was exposed, or the one before"),
  way("Run back", null, "R", "end", "Go back to the last breakpoint, or to the beginning"),
];

function way(name: string, key: string | null, letter: string, to: Way["to"], does: string): Way {
  const back = name.endsWith("back");
  return { name, short: SHORT[name] ?? (back ? "" : name), does, key, letter, back, to };
}

const NO_LINE = "Put the editor's cursor on a line with an instruction first.";

/** The reason that the last movement failed; empty if it did not. */
export const obstacle = signal("");

/** Go a way. */
export function go(way: Way): void {
  obstacle.value = "";
  if (way.to === "cursor") heard(goToCursor(way.back));
  else if (way.to !== "instruction") act().go({ to: way.to }, way.back);
}

async function goToCursor(back: boolean): Promise<void> {
  const at = cursor.value;
  const why = at ? await act().goToLine(at.file, at.line, back) : NO_LINE;
  if (why !== null) obstacle.value = why;
}

/** Return the way that a key press asks for; `letters` says whether letters count. */
export function wayOf(event: KeyboardEvent, letters: boolean): Way | null {
  if (event.altKey || event.metaKey) return null;
  const pressed = [event.ctrlKey ? "Ctrl+" : "", event.shiftKey ? "Shift+" : "", event.key].join("");
  const byKey = shortcuts.find(({ key }) => key === pressed);
  if (byKey) return byKey;
  const counts = letters && !event.ctrlKey;
  return (counts && shortcuts.find(({ letter }) => letter === event.key)) || null;
}
