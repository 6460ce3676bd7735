/** Messages between the page and the worker of the chip. */

import type { PackedBatch } from "./columns";
import type {
  Breakpoint,
  ChipView,
  Clip,
  Pace,
  ProgramInfo,
  Quantity,
  Stop,
  Travel,
} from "../protocol";

/** Orders of the page. Those with an `id` are answered. */
export type Order =
  | { to: "load"; module: Uint8Array<ArrayBuffer>; program: ProgramInfo; maxCycles: number }
  | { to: "stepping"; module: Uint8Array<ArrayBuffer> | null; why: string }
  | { to: "frames"; source: Clip | "live" | null }
  | { to: "feed"; frame: Uint8Array<ArrayBuffer> }
  | { to: "reset" }
  | { to: "breakpoints"; all: Breakpoint[] }
  | { to: "run"; pace: Pace }
  | { to: "pause" }
  | { to: "go"; travel: Travel; back: boolean }
  | { to: "wrote"; value: Quantity; writers: number[] }
  | { to: "profile"; frame: number }
  | { to: "whole"; module: Uint8Array<ArrayBuffer>; clip: Clip | null; maxCycles: number }
  | { to: "stopWhole" }
  /** A batch of frames was taken. */
  | { to: "taken" };

export interface Request {
  id: number;
  order: Order;
}

/** True for orders after which the chip begins anew: what it told before is of an older run. */
export function beginsAnew({ to }: Order): boolean {
  return to === "load" || to === "frames" || to === "reset";
}

/** Messages of the worker. `era`, `runs`: orders to begin anew, and to run, that it has taken up. */
export type Notice =
  | { of: "answer"; id: number; value: unknown }
  | { of: "refusal"; id: number; message: string }
  | { of: "frames"; batch: PackedBatch; era: number }
  | { of: "view"; view: ChipView; era: number }
  | { of: "stopped"; stop: Stop; era: number; runs: number }
  | { of: "progress"; share: number }
  | { of: "failed"; message: string };
