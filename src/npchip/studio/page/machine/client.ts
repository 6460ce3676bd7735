/** The page's end of the chip: speaks to its worker, and starts another when one was ended. */

import type { ChipClient, ChipEvents } from "../protocol";
import { unpacked } from "./columns";
import { beginsAnew, type Notice, type Order, type Request } from "./wire";

interface Waiting {
  resolve(value: unknown): void;
  reject(reason: Error): void;
}

const ENDED = "the chip was stopped: load the program again";

/** Make a chip whose worker `makeWorker` starts; `events` hears what happens. */
export function createChip(makeWorker: () => Worker, events: ChipEvents): ChipClient {
  // Its worker loads while the page looks for a program.
  let worker: Worker | null = start();
  let ids = 0;
  /** Orders to begin anew that were given. What the chip told before the last one is out of date. */
  let era = 0;
  /** Runs that were asked for; one that a newer one has cut short did not stop. */
  let runs = 0;
  const waiting = new Map<number, Waiting>();
  // A new worker has to be told these: frames and breakpoints stay when a program is loaded.
  let source: Order | null = null;
  let breaks: Order | null = null;

  function start(): Worker {
    const started = makeWorker();
    started.onmessage = ({ data }: MessageEvent<Notice>) => {
      if (started === worker) hear(data);
    };
    started.onerror = (event) => {
      event.preventDefault();
      if (started !== worker) return;
      end();
      events.failed(`the chip has failed: ${event.message || "its worker cannot be loaded"}`);
    };
    return started;
  }

  function hear(notice: Notice): void {
    switch (notice.of) {
      case "answer":
        waiting.get(notice.id)?.resolve(notice.value);
        waiting.delete(notice.id);
        break;
      case "refusal":
        waiting.get(notice.id)?.reject(new Error(notice.message));
        waiting.delete(notice.id);
        break;
      case "frames":
        try {
          if (notice.era === era) events.frames(unpacked(notice.batch));
        } finally {
          tell({ to: "taken" });
        }
        break;
      case "view":
        if (notice.era === era) events.view(notice.view);
        break;
      case "stopped":
        if (notice.era === era && notice.runs === runs) events.stopped(notice.stop);
        break;
      case "progress":
        events.progress(notice.share);
        break;
      case "failed":
        events.failed(notice.message);
    }
  }

  /** Give an order whose answer nobody waits for, but whose failure the page hears of. */
  function tell(order: Order): void {
    if (!worker) return;
    ask(order).catch(({ message }: Error) => {
      if (message !== ENDED) events.failed(message);
    });
  }

  function ask<T>(order: Order, handOver: Transferable[] = []): Promise<T> {
    if (!worker) {
      worker = start();
      era = runs = 0;
      for (const known of [source, breaks]) if (known && known.to !== order.to) tell(known);
    }
    const request: Request = { id: ++ids, order };
    const answer = new Promise<T>((resolve, reject) => {
      waiting.set(request.id, { resolve: resolve as (value: unknown) => void, reject });
    });
    worker.postMessage(request, handOver);
    if (order.to === "run") runs++;
    if (beginsAnew(order)) {
      era++;
      events.begun();
    }
    return answer;
  }

  function end(): void {
    worker?.terminate();
    worker = null;
    const left = [...waiting.values()];
    waiting.clear();
    // Whoever ends the chip, or hears of its failure, says why.
    for (const { reject } of left) reject(new DOMException(ENDED, "AbortError"));
  }

  return {
    load: (module, program, maxCycles) => ask({ to: "load", module, program, maxCycles }),
    stepping: (module, why = "") => ask({ to: "stepping", module, why }),
    async frames(given) {
      const order: Order = { to: "frames", source: given };
      await ask(order);
      source = order; // one that was refused is not kept
    },
    feed: (frame) =>
      ask<"done" | "dropped">({ to: "feed", frame }, [frame.buffer]).catch((fault: Error) => {
        if (fault.message === ENDED) return "dropped";
        throw fault;
      }),
    reset: () => ask({ to: "reset" }),
    breakpoints(all) {
      breaks = { to: "breakpoints", all };
      return ask(breaks);
    },
    run: (pace) => tell({ to: "run", pace }),
    pause: () => tell({ to: "pause" }),
    go: (travel, back) => ask({ to: "go", travel, back }),
    wrote: (value, writers) => ask({ to: "wrote", value, writers }),
    profile: (frame) => ask({ to: "profile", frame }),
    whole: (module, _program, clip, maxCycles) => ask({ to: "whole", module, clip, maxCycles }),
    stopWhole: () => tell({ to: "stopWhole" }),
    terminate: end,
  };
}
