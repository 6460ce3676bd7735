/** The reader's own files as clips. */

import { check, equal } from "../driver/expect";
import { flow } from "../driver/flow";
import type { Session } from "../driver/session";
import { give, openExample } from "../driver/studio";

interface Given {
  paths: string[];
  /** Answer to the question how to fit it; null if there must be none. */
  fit: "Crop" | "Resize" | null;
}

/** Open files as a clip, and return its frames as the chip gets them. */
async function clip(t: Session, { paths, fit }: Given) {
  const before = await t.page.evaluate(() => {
    globalThis.before = npchip.store.clip.value;
    return npchip.store.message.value.text;
  });
  await give(t, "Clip file", paths);
  if (fit) await t.press(fit);
  await t.until(
    `the clip ${paths[0]} is read`,
    (said) => {
      const { message } = npchip.store;
      if (message.value.kind === "error" && message.value.text !== said) throw new Error(message.value.text);
      return npchip.store.clip.value !== globalThis.before;
    },
    [before] as const,
    { timeout: 60_000 },
  );
  return t.page.evaluate(() => {
    const found = npchip.store.clip.value;
    if (found === null || found === "live") throw new Error("there is no clip");
    const { rows, cols, count, data } = found;
    let letters = "";
    for (let at = 0; at < data.length; at += 8192) {
      letters += String.fromCharCode(...data.subarray(at, at + 8192));
    }
    return { rows, cols, count, data: btoa(letters) };
  });
}

declare global {
  var before: unknown;
}

flow(
  "files: clips become frames",
  async (t) => {
    await openExample(t, "trajectory", "coin_slide");
    const clips: Record<string, unknown> = {};
    for (const [name, given] of Object.entries(t.parameter<Record<string, Given>>("clips"))) {
      clips[name] = await clip(t, given).catch((thrown: Error) => ({ error: thrown.message }));
    }
    t.report["clips"] = clips;
  },
  { seconds: 180 },
);

flow("files: broken ones get a message and change nothing", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  const name = await t.page.evaluate(() => (npchip.store.clip.value as { name: string }).name);
  const said: Record<string, string> = {};
  for (const path of t.parameter<string[]>("broken")) {
    await t.page.evaluate(() => {
      npchip.store.message.value = { kind: "info", text: "" };
    });
    await give(t, "Clip file", [path]);
    const file = path.slice(path.lastIndexOf("/") + 1);
    said[file] = await t.message(/Problem/, { timeout: 20_000 }).catch((thrown: Error) => thrown.message);
    const now = await t.page.evaluate(() => (npchip.store.clip.value as { name: string }).name);
    equal(now, name, `the clip after ${file}`);
  }
  t.report["said"] = said;
});

flow("files: the question how to fit can be taken back", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  const name = await t.page.evaluate(() => (npchip.store.clip.value as { name: string }).name);
  await give(t, "Clip file", t.parameter<string[]>("paths"));
  // Reading a file can be cancelled too.
  await t.until("the question is asked", () => document.querySelector("dialog[open]") !== null);
  await t.press("Cancel");
  await t.until("the question is gone", () => document.querySelector("dialog[open]") === null);
  const now = await t.page.evaluate(() => (npchip.store.clip.value as { name: string }).name);
  equal(now, name, "the clip");
});

flow("files: sources are opened", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await give(t, "Open", t.parameter<string[]>("paths"));
  await t.until("the source is in the page", (text) => {
    const { main, files } = npchip.store.project.value;
    return files[main] === text;
  }, [t.parameter<string>("text")] as const);
  await give(t, "Open", t.parameter<string[]>("broken"));
  const said = await t.message(/UTF-8/);
  check(said.includes("Problem"), `the message is no error: ${said}`);
  equal(await t.program(), t.parameter<string>("text"), "the program after a broken file");
});
