/** The scene that the reader draws: kept in the browser, and the clip again after a reload. */

import { effect } from "@preact/signals";
import { type Drawing, drawingIn, drawnClip } from "../frames/draw";
import { sayError } from "../say";
import { chosenClip, frameSize, give } from "./clips";
import { keepDrawing, keptDrawing } from "./keep";

interface Kept {
  drawing: Drawing;
  /** True if it is the clip. */
  used: boolean;
}

let kept: Kept | null = read(keptDrawing());

function read(text: string | null): Kept | null {
  try {
    const found = Object(JSON.parse(text ?? "null")) as Record<string, unknown>;
    const drawing = drawingIn(found["drawing"]);
    return drawing && { drawing, used: found["used"] === true };
  } catch {
    return null;
  }
}

/** Longest text of a drawing that is kept: programs need room, too. */
const MOST = 1 << 19;

function keep(now: Kept): void {
  const before = kept;
  kept = now;
  const text = JSON.stringify(now);
  if (text.length <= MOST) keepDrawing(text);
  else if (before && JSON.stringify(before).length <= MOST) {
    sayError(new Error("The drawing is too long to be kept over a reload: save it as .npy"));
  }
}

/** The last drawing; null if there is none. */
export function drawing(): Drawing | null {
  return kept?.drawing ?? null;
}

/** The drawing has changed. */
export function drawn(now: Drawing): void {
  keep({ drawing: now, used: kept?.used ?? false });
}

/** Use what was drawn as the clip, in the size that the machine takes. */
export async function useScene(): Promise<void> {
  if (kept) await give(drawnClip({ ...kept.drawing, ...frameSize() }), "scene");
}

/** Use the scene again if it was the clip at the last visit. */
export async function sceneAgain(): Promise<void> {
  if (kept?.used) await useScene();
}

/** Note from now on whether the scene is the clip. */
export function followScene(): void {
  effect(() => {
    const used = chosenClip.value === "scene";
    if (kept && kept.used !== used) keep({ ...kept, used });
  });
}
