/** The worker of the chip: hands orders to it, and its answers and events to the page. */

import { Chip } from "./chip";
import { buffersOf } from "./columns";
import type { Notice, Order, Request } from "./wire";

const scope = self as unknown as DedicatedWorkerGlobalScope;

function say(notice: Notice, handOver: Transferable[] = []): void {
  scope.postMessage(notice, handOver);
}

const chip = new Chip({
  frames: (batch) => say({ of: "frames", batch, era: chip.era }, buffersOf(batch)),
  view: (view) => say({ of: "view", view, era: chip.era }),
  stopped: (stop) => say({ of: "stopped", stop, era: chip.era, runs: chip.runs }),
  progress: (share) => say({ of: "progress", share }),
  failed: (message) => say({ of: "failed", message }),
});

function carryOut(order: Order): unknown {
  switch (order.to) {
    case "load":
      return chip.load(order.module, order.program, order.maxCycles);
    case "stepping":
      return chip.stepping(order.module, order.why);
    case "frames":
      return chip.frames(order.source);
    case "feed":
      return chip.feed(order.frame);
    case "reset":
      return chip.reset();
    case "breakpoints":
      return chip.breakpoints(order.all);
    case "run":
      return chip.run(order.pace);
    case "pause":
      return chip.pause();
    case "go":
      return chip.go(order.travel, order.back);
    case "wrote":
      return chip.wrote(order.value, order.writers);
    case "profile":
      return chip.profile(order.frame);
    case "whole":
      return chip.whole(order.module, order.clip, order.maxCycles);
    case "taken":
      return chip.taken();
  }
}

scope.onmessage = async ({ data }: MessageEvent<Request>) => {
  const { id, order } = data;
  try {
    say({ of: "answer", id, value: await carryOut(order) });
  } catch (fault) {
    say({ of: "refusal", id, message: fault instanceof Error ? fault.message : String(fault) });
  }
};
