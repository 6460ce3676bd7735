/** What runs in the page, for a test that compares it with npchip. */

import { flow } from "../driver/flow";
import type { Session } from "../driver/session";
import { assembling, ended, openExample, still } from "../driver/studio";

interface Place {
  example: string;
  clip: string;
}

/** The run as the page has it, handed over as a text: Firefox's protocol wraps each number in an object. */
async function document(t: Session): Promise<unknown> {
  const text = await t.page.evaluate(() => {
    const { batches, view } = npchip.store;
    const frames: unknown[] = [];
    for (const batch of batches.value) {
      batch.cycles.forEach((cycles, index) => {
        const outputs = Object.entries(batch.outputs).map(([name, column]) => {
          const value = column.values[index];
          if (value === null || value === undefined || Number.isNaN(value)) return [name, null];
          return [name, value instanceof Uint8Array ? [...value] : value];
        });
        frames.push({ cycles, outputs: Object.fromEntries(outputs) });
      });
    }
    const { status, error, cycles, instructions } = view.value!;
    return JSON.stringify({ status, error, cycles, instructions, frames });
  });
  return JSON.parse(text);
}

/** True if no work of the page is under way. */
const nothingLoads = () => npchip.store.progress.value === null;

flow(
  "agreement: programs on clips",
  async (t) => {
    await openExample(t, "trajectory", "coin_slide");
    await assembling(t);
    await t.choose("Speed", "As fast as it goes");
    const machine = t.parameter<string>("machine");
    await t.choose("Machine", machine);
    await t.message(/^Machine: /, { timeout: 60_000 });
    const documents: unknown[] = [];
    let last = "trajectory";
    for (const { example, clip } of t.parameter<Place[]>("places")) {
      // One that is open already would be assembled once more.
      if (example !== last) await t.choose("Example", example);
      last = example;
      const open = (name: string, machine: string) => {
        const made = npchip.store.compiled.value?.program;
        return made?.name === name && made.machine.name === machine;
      };
      await t.until(`${example} is open`, open, [example, machine] as const);
      await t.until("its own clip has come", nothingLoads);
      const isThere = (name: string) => {
        const now = npchip.store.clip.value;
        return now !== null && now !== "live" && now.name.includes(name);
      };
      // One that is chosen again is given to the chip again, which ends a run.
      if (!(await t.page.evaluate(isThere, clip))) await t.choose("Clip", clip);
      await t.until(`${clip} is there`, isThere, [clip] as const);
      await t.until("the chip has it", nothingLoads);
      // One that needs a partner is not put into the chip before it is run.
      const inChip = (name: string, machine: string) => {
        const made = npchip.store.program.value;
        return made?.name === name && made.machine.name === machine && !npchip.store.running.value;
      };
      // Not by buttons, which other flows press: they take longer than the runs.
      if (!(await t.page.evaluate(inChip, example, machine))) await t.page.evaluate(() => npchip.act().run());
      await t.until(`${example} is in the chip`, inChip, [example, machine] as const);
      await t.page.evaluate(() => npchip.act().reset());
      await t.until("the chip is reset", () => npchip.store.view.value?.instructions === 0);
      await t.page.evaluate(() => npchip.act().run());
      await ended(t);
      documents.push(await document(t));
    }
    t.report["documents"] = documents;
  },
  { seconds: 400 },
);

/** A control, what to choose in it, and the milliseconds before the next one. */
type Click = [string, string, number];

flow(
  "agreement: clicks that do not wait",
  async (t) => {
    await t.page.evaluateOnNewDocument(countFetches);
    await openExample(t, "trajectory", "coin_slide");
    await t.choose("Speed", "As fast as it goes");
    const found: unknown[] = [];
    for (const clicks of t.parameter<Click[][]>("sequences")) {
      await t.page.evaluate(clickAll, clicks);
      await t.until("what was fetched has come", () => globalThis.quiet() > 150);
      await t.until("the program is in the chip", () => {
        const { compiled, program, progress } = npchip.store;
        return compiled.value?.program?.name === program.value?.name && progress.value === null;
      });
      await still(t);
      const { program, clip } = await t.page.evaluate(() => {
        const { program, clip } = npchip.store;
        return { program: program.value?.name, clip: clip.value && clip.value !== "live" ? clip.value.name : "" };
      });
      await still(t);
      await t.press("Reset");
      await t.until("the chip is reset", () => !npchip.store.running.value && npchip.store.view.value?.instructions === 0);
      await t.press("Run");
      await ended(t);
      found.push({ program, clip, document: await document(t) });
    }
    t.report["found"] = found;
  },
  { seconds: 400 },
);

declare global {
  /** Milliseconds since the page waited for a fetch. */
  var quiet: () => number;
}

function countFetches(): void {
  const plain = globalThis.fetch;
  let waiting = 0;
  let last = 0;
  globalThis.fetch = async (...wanted) => {
    waiting += 1;
    try {
      const response = await plain(...wanted);
      await response.clone().arrayBuffer();
      return response;
    } finally {
      waiting -= 1;
      last = performance.now();
    }
  };
  globalThis.quiet = () => (waiting > 0 ? 0 : performance.now() - last);
}

/** Click in the page itself: that is faster than any reader. */
async function clickAll(clicks: Click[]): Promise<void> {
  for (const [name, wanted, wait] of clicks) {
    const labelled = (box: Element) => box.closest("label")?.querySelector("span")?.textContent === name;
    const box = [...window.document.querySelectorAll("select")].find(labelled);
    const named = (each: Element) => each.textContent?.trim() === name;
    if (box) {
      box.value = wanted;
      box.dispatchEvent(new Event("change", { bubbles: true }));
    } else [...window.document.querySelectorAll("button")].find(named)?.click();
    await new Promise((resolve) => setTimeout(resolve, wait));
  }
}

flow(
  "agreement: modules are the same bytes",
  async (t) => {
    await openExample(t, "trajectory", "coin_slide");
    await assembling(t);
    const digests: Record<string, string> = {};
    for (const [name, files] of Object.entries(t.parameter<Record<string, Record<string, string>>>("sources"))) {
      for (const machine of t.parameter<string[]>("machines")) {
        digests[`${name} ${machine}`] = await t.page.evaluate(
          async (main, all, machineName) => {
            const project = { main, files: all };
            const request = { project, machine: { name: machineName }, defines: {}, memory: [], module: true };
            const { module, diagnostics } = await npchip.compiler().compile(request);
            if (!module) return diagnostics.map((each) => each.message).join("; ");
            const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", module));
            return Array.from(digest, (byte) => byte.toString(16).padStart(2, "0")).join("");
          },
          `${name}.s`,
          files,
          machine,
        );
      }
    }
    t.report["digests"] = digests;
  },
  { seconds: 240 },
);

flow(
  "agreement: states at instructions",
  async (t) => {
    await openExample(t, t.parameter("program"), t.parameter("clip"));
    await t.press("Reset");
    t.report["states"] = await t.page.evaluate(async (numbers) => {
      const chip = npchip.chip();
      const states: unknown[] = [];
      for (const number of numbers) {
        await chip.go({ to: "instruction", number }, number < (npchip.store.view.value?.instructions ?? 0));
        const view = npchip.store.view.value!;
        const planes = [view.registers, view.zero, view.carry, view.active, ...view.masks, view.memory];
        const bytes = new Uint8Array(await new Blob(planes.map((plane) => plane.slice())).arrayBuffer());
        const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
        const { address, stack, depth, frame, frameCycles, cycles, instructions } = view;
        states.push({
          ...{ address, stack, depth, frame, frameCycles, cycles, instructions },
          planes: Array.from(digest, (byte) => byte.toString(16).padStart(2, "0")).join(""),
        });
      }
      return states;
    }, t.parameter<number[]>("numbers"));
  },
  { seconds: 200 },
);
