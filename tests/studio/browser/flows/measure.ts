/** What `python -m benchmarks studio` measures in a browser. */

import { readdir, readFile } from "node:fs/promises";
import { flow } from "../driver/flow";
import type { Session } from "../driver/session";
import { assembling, LOADING, mistakes, moving, openExample, still } from "../driver/studio";


async function marks(t: Session): Promise<{ picture: number; ready: number }> {
  await moving(t);
  await assembling(t);
  return t.page.evaluate(() => {
    const at = (name: string) => (performance.getEntriesByName(name)[0]?.startTime ?? Number.NaN) / 1000;
    return { picture: at("npchip:first-picture"), ready: at("npchip:compiler-ready") };
  });
}

flow(
  "measure: loading",
  async (t) => {
    // A program that the browser keeps would not start by itself.
    await t.page.evaluateOnNewDocument(() => {
      if (location.protocol === "http:") localStorage.removeItem("npchip.program");
    });
    await t.open();
    t.report["first"] = await marks(t);
    await t.until(
      "the service worker keeps the page",
      async () => (await navigator.serviceWorker.ready).active?.state === "activated",
      [],
      { timeout: LOADING },
    );
    await t.until("nothing is loading", () => npchip.store.progress.value === null);
    await t.page.goto("about:blank");
    await t.open();
    t.report["second"] = await marks(t);
    t.report["megabytes"] = await memory(t);
  },
  { seconds: 200 },
);

/** Memory of the browser's process that holds the page, in MB: shared pages count in part. */
async function memory(t: Session): Promise<number> {
  const browser = t.page.browser().process()?.pid ?? 0;
  const parents = new Map<number, number>();
  for (const name of await readdir("/proc")) {
    if (!/^\d+$/.test(name)) continue;
    const status = await readFile(`/proc/${name}/status`, "utf8").catch(() => "");
    parents.set(Number(name), Number(/^PPid:\s+(\d+)/m.exec(status)?.[1] ?? 0));
  }
  const descends = (pid: number): boolean => {
    const parent = parents.get(pid) ?? 0;
    return parent === browser || (parent > 1 && descends(parent));
  };
  let most = 0;
  for (const pid of [...parents.keys()].filter(descends)) {
    const command = await readFile(`/proc/${pid}/cmdline`, "utf8").catch(() => "");
    if (!/--type=renderer|contentproc/.test(command)) continue;
    const text = await readFile(`/proc/${pid}/smaps_rollup`, "utf8").catch(() => "");
    most = Math.max(most, Number(/^Pss:\s+(\d+)/m.exec(text)?.[1] ?? 0) / 1024);
  }
  return most;
}

flow(
  "measure: editing",
  async (t) => {
    const program = t.parameter<string>("program");
    await openExample(t, "trajectory", "city_night");
    await assembling(t);
    await t.write(program);
    await mistakes(t, "none");
    const seconds: number[] = [];
    // The first edits warm the assembler up.
    for (let round = 0; round < t.parameter<number>("rounds") + 2; round += 1) {
      await t.press("Reset");
      await t.press("Run");
      await t.until("it runs", () => npchip.store.frameCount.value > 0);
      const took = await t.page.evaluate(
        (text) =>
          new Promise<number>((resolve, reject) => {
            const before = npchip.store.program.value;
            const start = performance.now();
            const giveUp = setTimeout(() => reject(new Error("no result of the edit within 20 s")), 20_000);
            const end = npchip.store.batches.subscribe((batches) => {
              if (npchip.store.program.value === before || batches.length === 0) return;
              clearTimeout(giveUp);
              setTimeout(() => end());
              resolve(performance.now() - start);
            });
            npchip.act().edit(npchip.store.project.value.main, text);
          }),
        `${program}; edit ${round}\n`,
      );
      if (round >= 2) seconds.push(took / 1000);
    }
    t.report["seconds"] = seconds;
    t.report["words"] = await t.page.evaluate(() => npchip.store.program.value?.words.length);
  },
  { seconds: 200 },
);

async function long(t: Session, count: number): Promise<void> {
  await openExample(t, "trajectory", "coin_slide");
  await t.press("Reset");
  await still(t);
  await t.page.evaluate(async (frames) => {
    const clip = npchip.store.clip.value;
    if (clip === null || clip === "live") throw new Error("there is no clip");
    const data = new Uint8Array(frames * clip.rows * clip.cols);
    for (let at = 0; at < data.length; at += clip.data.length) {
      data.set(clip.data.subarray(0, Math.min(clip.data.length, data.length - at)), at);
    }
    await npchip.chip().frames({ ...clip, count: frames, data });
  }, count);
}

flow(
  "measure: frames a second",
  async (t) => {
    const count = t.parameter<number>("frames");
    await long(t, count);
    await t.choose("Speed", "As fast as it goes");
    const seconds: number[] = [];
    for (let round = 0; round <= t.parameter<number>("rounds"); round += 1) {
      await t.press("Reset");
      await t.until("the chip is reset", () => npchip.store.view.value?.instructions === 0);
      const took = await t.page.evaluate(
        () =>
          new Promise<number>((resolve) => {
            npchip.store.stop.value = null;
            const start = performance.now();
            npchip.store.stop.subscribe((stop) => {
              if (stop?.reason === "ended") resolve(performance.now() - start);
            });
            npchip.act().run();
          }),
      );
      const frames = await t.page.evaluate(() => npchip.store.frameCount.value);
      if (frames !== count) throw new Error(`${frames} frames were run, not ${count}`);
      if (round > 0) seconds.push(took / 1000);
    }
    t.report["seconds"] = seconds;
  },
  { seconds: 200 },
);

flow(
  "measure: back",
  async (t) => {
    const number = t.parameter<number>("instruction");
    await long(t, t.parameter<number>("frames"));
    t.report["seconds"] = await t.page.evaluate(
      async (wanted, rounds) => {
        const seconds: number[] = [];
        for (let round = 0; round < rounds; round += 1) {
          await npchip.chip().go({ to: "instruction", number: wanted }, false);
          const start = performance.now();
          await npchip.chip().go({ to: "step" }, true);
          seconds.push((performance.now() - start) / 1000);
          const now = npchip.store.view.value?.instructions;
          if (now !== wanted - 1) throw new Error(`a step back from ${wanted} led to ${now}`);
        }
        return seconds;
      },
      number,
      t.parameter<number>("rounds"),
    );
  },
  { seconds: 200 },
);
