/** The compiler's worker: loads Pyodide from beside the page, and answers calls in order. */

import type { loadPyodide } from "pyodide";
import type { Call, FromWorker, Loading, ToWorker } from "./messages";
import { type Python, startPython } from "./python";

/** Milliseconds without a call after which code is warmed up that a first edit would find cold. */
const IDLE = 100;

/** Milliseconds without another call after which bounds are looked for, which takes long. */
const PAUSE = 500;
/** The answer to bounds that a later call asks for again. */
const NOTHING = '{"value":null}';

let python: Promise<Python> | null = null;
let lastCall = 0;
let lastBounds = -1;

self.addEventListener("message", (event: MessageEvent<ToWorker>) => {
  const message = event.data;
  if ("base" in message) begin(message.base);
  else void answer(message);
});

function begin(base: string): void {
  python = start(base);
  python.then(
    (ready) => {
      say({ kind: "ready" });
      lastCall = performance.now();
      void quiet(IDLE)
        .then(() => ready.warm())
        .catch((error: unknown) => console.info("npchip: not warmed up:", String(error)));
    },
    (error: unknown) => fail("The compiler cannot be loaded", error),
  );
}

async function start(base: string): Promise<Python> {
  const indexURL = new URL("pyodide/", base).href;
  const load = import(`${indexURL}pyodide.mjs`).then(
    (pyodide: { loadPyodide: typeof loadPyodide }) => pyodide.loadPyodide,
  );
  load.catch(() => undefined); // whoever waits for it tells
  // Pyodide imports it too, once it has been loaded itself.
  import(`${indexURL}pyodide.asm.mjs`).catch(() => undefined);
  return startPython(load, indexURL, (path, onShare) => fetched(new URL(path, base), onShare), (loading: Loading) =>
    say({ kind: "loading", loading }),
  );
}

async function answer(call: Call): Promise<void> {
  const ready = await python?.catch(() => null);
  if (!ready) return; // `failed` was said
  if (call.method === "bounds") {
    lastBounds = call.id;
    await quiet(PAUSE);
    if (lastBounds !== call.id) {
      say({ kind: "answer", id: call.id, text: NOTHING, module: null });
      return;
    }
  }
  try {
    const { text, module } = ready.call(call.method, call.args, call.blobs);
    say({ kind: "answer", id: call.id, text, module }, module ? [module.buffer] : []);
  } catch (error) {
    // Python's own errors come back as answers: its machine itself is broken.
    fail("The compiler broke down", error);
  }
  lastCall = performance.now();
}

/** Wait until there was no call for some milliseconds: Python hears no edit while it works. */
async function quiet(milliseconds: number): Promise<void> {
  for (;;) {
    const left = lastCall + milliseconds - performance.now();
    if (left <= 0) return;
    await new Promise((resolve) => setTimeout(resolve, left));
  }
}

async function fetched(
  url: URL,
  onShare: (share: number | null) => void,
): Promise<Uint8Array<ArrayBuffer>> {
  const response = await fetch(url);
  if (!response.ok || !response.body) throw new Error(`${url.pathname}: ${response.status}`);
  // A server that compresses tells the size of what it sends, not of what arrives here.
  const whole = response.headers.has("Content-Encoding")
    ? 0
    : Number(response.headers.get("Content-Length"));
  const parts: Uint8Array<ArrayBuffer>[] = [];
  let size = 0;
  onShare(whole ? 0 : null);
  for (const reader = response.body.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) break;
    parts.push(value);
    size += value.length;
    onShare(whole ? Math.min(1, size / whole) : null);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

function say(message: FromWorker, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

function fail(what: string, error: unknown): void {
  const [reason] = String(error instanceof Error ? error.message : error).split("\n");
  say({ kind: "failed", message: `${what}: ${reason}` });
}
