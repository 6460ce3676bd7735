/** Goes forward and back as a reader asks, and says why it stopped. */

import type { Breakpoint, Stop, Travel } from "../protocol";
import { type Hit, Watch } from "./conditions";
import { Forward, type Goal } from "./forward";
import { type Breathe, type Past, SLICE } from "./past";
import { lastAt, lastHit } from "./search";
import type { Stepper } from "./stepper";

/** Functions that a movement needs from outside the chip. */
export interface Surroundings {
  breathe: Breathe;
  /** Wait for a live frame; true if the movement is to be given up. */
  frame: () => Promise<boolean>;
  progress: (share: number) => void;
}

export const PAUSED: Stop = { reason: "paused", text: "paused" };
const BEGINNING: Stop = { reason: "beginning", text: "at the beginning" };
const NOT_KEPT: Stop = {
  reason: "beginning",
  text: "live frames before this one are no longer kept: this is as far back as it goes",
};

/** A chip that moved, and why it stopped. */
export interface Moved {
  chip: Stepper;
  stop: Stop;
}

const depthOf = (block: { stack?: number[] }): number => block.stack?.length ?? 0;

export async function forward(
  past: Past,
  chip: Stepper,
  travel: Travel,
  breakpoints: Breakpoint[],
  around: Surroundings,
): Promise<Moved> {
  if (travel.to === "instruction") return seek(past, chip, travel.number, around);
  if (travel.to === "out" && !depthOf(chip.here)) {
    return { chip, stop: { reason: "step", text: "no call is open" } };
  }
  const { goal, text } = goalOf(chip, travel);
  const way = new Forward(chip, new Watch(chip, breakpoints), goal);
  const next = chip.time + 1;
  const isOver = travel.to === "over";
  for (;;) {
    switch (way.slice(SLICE)) {
      case "goal":
        // Without a call to step over, it was a plain step.
        if (isOver && chip.time === next) return { chip, stop: { reason: "step", text: "stepped" } };
        return { chip, stop: { reason: "step", text } };
      case "hit":
        return { chip, stop: hitStop(way.hit) };
      case "ended":
        return { chip, stop: endStop(past, chip) };
      case "waiting":
        if (await around.frame()) return { chip, stop: PAUSED };
        break;
      case "slice":
        if (await around.breathe()) return { chip, stop: PAUSED };
    }
  }
}

function goalOf(
  chip: Stepper,
  travel: Exclude<Travel, { to: "instruction" }>,
): { goal: Goal; text: string } {
  const depth = depthOf(chip.here);
  switch (travel.to) {
    case "step":
      return { goal: { time: chip.time + 1 }, text: "stepped" };
    case "over": // only a call makes the stack deeper, so anything else is one step
      return { goal: { at: (block) => depthOf(block) <= depth }, text: "stepped over the call" };
    case "out":
      return { goal: { at: (block) => depthOf(block) < depth }, text: "returned" };
    case "frame": {
      const frame = chip.frame + 1;
      return { goal: { frame }, text: `frame ${frame} is exposed` };
    }
    case "cursor": {
      const places = new Set(travel.addresses);
      return { goal: { at: (block) => places.has(block.address) }, text: "reached the cursor" };
    }
    case "end":
      return { goal: {}, text: "" };
  }
}

/** Return the reason for a stop at a breakpoint. */
export function hitStop(hit: Hit | null): Stop {
  const text = hit?.condition?.text;
  return text ? { reason: "condition", text } : { reason: "breakpoint", text: "breakpoint" };
}

/** Return the reason for the end of a run. */
export function endStop(past: Past, chip: Stepper): Stop {
  return { reason: "ended", text: endText(past, chip) };
}

function endText(past: Past, { ended, frame }: Stepper): string {
  switch (ended?.status) {
    case "halted":
      return "the program has halted";
    case "cycle-limit": {
      const what = frame < 0 ? "the part before the first frame" : `frame ${frame}`;
      return `${what} has reached ${past.limit.toLocaleString("en")} cycles`;
    }
    case "failed":
      return `${ended.error?.message} [${ended.error?.code}]`;
    default:
      return past.source.kind === "none" ? "no frames were given" : "no frame is left";
  }
}

export async function back(
  past: Past,
  chip: Stepper,
  travel: Travel,
  breakpoints: Breakpoint[],
  around: Surroundings,
): Promise<Moved> {
  const now = chip.time;
  const depth = depthOf(chip.here);
  const go = (time: number, stop: Stop) => seek(past, chip, time, around, stop);
  const last = (holds: (block: { address: number; stack?: number[] }) => boolean) =>
    lastAt(past, now - 1, holds, around.breathe, around.progress);
  switch (travel.to) {
    case "instruction":
      return seek(past, chip, travel.number, around);
    case "step":
      return go(now - 1, { reason: "step", text: "stepped back" });
    case "frame":
      return previousFrame(past, chip, around);
    case "over": {
      const found = await last((block) => depthOf(block) <= depth);
      const text = found === now - 1 ? "stepped back" : "stepped back over the call";
      return arrive(found, { reason: "step", text });
    }
    case "out": {
      if (!depth) return { chip, stop: { reason: "step", text: "no call is open" } };
      const found = await last((block) => depthOf(block) < depth);
      return arrive(found, { reason: "step", text: "back before the call" });
    }
    case "cursor": {
      const places = new Set(travel.addresses);
      const found = await last((block) => places.has(block.address));
      return arrive(found, { reason: "step", text: "back at the cursor" });
    }
    case "end": {
      if (!breakpoints.length) return go(0, BEGINNING);
      const { breathe, progress } = around;
      const found = await lastHit(past, now - 1, breakpoints, breathe, progress);
      if (found === "given up") return { chip, stop: PAUSED };
      return found ? go(found.time, hitStop(found.hit)) : go(0, BEGINNING);
    }
  }

  function arrive(found: number | null | "given up", stop: Stop): Promise<Moved> | Moved {
    if (found === "given up") return { chip, stop: PAUSED };
    return found === null ? go(0, BEGINNING) : go(found, stop);
  }
}

/** Go to a moment; without a stop of its own it says which. */
async function seek(
  past: Past,
  chip: Stepper,
  time: number,
  around: Surroundings,
  stop?: Stop,
): Promise<Moved> {
  const wanted = Math.max(0, time);
  let isGivenUp = false;
  const breathe = async () => (isGivenUp = await around.breathe());
  const there = await past.seek(chip, wanted, breathe);
  if (isGivenUp) return { chip: there, stop: PAUSED };
  if (there.time > wanted) return { chip: there, stop: NOT_KEPT };
  if (there.time < wanted && there.ended) return { chip: there, stop: endStop(past, there) };
  const isHit = stop?.reason === "breakpoint" || stop?.reason === "condition";
  if (!there.time && !isHit) return { chip: there, stop: BEGINNING };
  const text = `at instruction ${there.time.toLocaleString("en")}`;
  return { chip: there, stop: stop ?? { reason: "step", text } };
}

/** Go back to just after the exposure of this frame, or of the one before if it is there. */
async function previousFrame(past: Past, chip: Stepper, around: Surroundings): Promise<Moved> {
  const now = chip.time;
  // At most the last instruction can have exposed this frame.
  const isJustExposed = chip.frame >= 0 && !chip.halted && (await exposedAt(chip.frame)) === now;
  const frame = chip.frame - (isJustExposed ? 1 : 0);
  if (frame < 0) return seek(past, chip, 0, around, BEGINNING);
  const time = await exposedAt(frame);
  if (time === null) return { chip, stop: PAUSED };
  return seek(past, chip, time, around, { reason: "step", text: `frame ${frame} is exposed` });

  /** The moment just after a frame was exposed; the oldest in reach if that is later. */
  async function exposedAt(wanted: number): Promise<number | null> {
    const moments = past.history.until(now + 1);
    const start = moments.find((moment) => moment.frame < wanted) ?? past.history.oldest;
    if (start.frame >= wanted) return start.time - 1;
    const scout = past.put(past.scout(), start);
    const way = new Forward(scout, new Watch(scout, []), { frame: wanted });
    while (way.slice(SLICE) === "slice") if (await around.breathe()) return null;
    return scout.time;
  }
}
