/** Write a program: mistakes, breakpoints, what is kept, what is shared. */

import { check, equal } from "../driver/expect";
import { flow } from "../driver/flow";
import type { Session } from "../driver/session";
import { assembling, ended, LOADING, mistakes, opened, openExample, says, still, travel } from "../driver/studio";

const GOOD = `; counts frames
.output count, 0, scalar
frame:  EXPOSE
        ADD     r0, #1
        OUT     0, r0
        JMP     frame
`;

/** Wait until the page holds a text, and keeps it. */
async function kept(t: Session, text: string): Promise<void> {
  await t.until(
    "the browser keeps the program",
    (wanted) => Object.values(localStorage).some((each) => String(each).includes(wanted)),
    [JSON.stringify(text).slice(1, -1)] as const,
  );
}

flow("write: a mistake is underlined and listed, and goes when it is mended", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await assembling(t);
  await t.write(GOOD.replace("ADD ", "ADE "));
  const [message] = await mistakes(t, "some");
  await t.until("the mistake is underlined", () => document.querySelector(".cm-lintRange-error, .cm-lintRange"));
  await says(t, new RegExp((message as string).slice(0, 20).replace(/[.*+?^${}()|[\]\\]/g, "\\$&")));
  await t.write(GOOD);
  await mistakes(t, "none");
  await t.until("no underline is left", () => !document.querySelector(".cm-lintRange-error"));
  await t.press("Run");
  equal(await ended(t), "frames-exhausted", "the end of the run");
  const counts = await t.page.evaluate(() =>
    npchip.store.batches.value.flatMap((batch) => {
      const column = batch.outputs["count"];
      return column?.kind === "scalar" ? [...column.values] : [];
    }),
  );
  equal(counts.slice(-3), [counts.length - 2, counts.length - 1, counts.length], "the last counts");
});

flow("write: undo brings an example back", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  const before = await t.program();
  await t.write(GOOD);
  await t.until("the text has changed", (was) => npchip.store.project.value.files[npchip.store.project.value.main] !== was, [before] as const);
  for (let presses = 0; presses < 10 && (await t.program()) !== before; presses += 1) await t.chord("Control", "z");
  equal(await t.program(), before, "the program after undo");
});

flow("write: choose another example and clip", async (t) => {
  await opened(t);
  await t.choose("Example", "frame_difference");
  await t.until("the example is open", () => npchip.store.program.value?.name === "frame_difference");
  await t.choose("Clip", "shapes_drawn");
  await t.until("the clip is there", () => {
    const clip = npchip.store.clip.value;
    return clip && clip !== "live" && clip.name.includes("shapes_drawn");
  });
  await still(t);
  await t.press("Reset");
  await t.press("Run");
  equal(await ended(t), "frames-exhausted", "the end of the run");
  const [heads] = await t.outputs();
  equal(heads?.at(-1), "cycles", "the last head of the table");
});

flow("write: a breakpoint stops, steps go over and out", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await assembling(t);
  const { file, line } = await t.page.evaluate(() => {
    const { main, files } = npchip.store.project.value;
    const lines = (files[main] ?? "").split("\n");
    return { file: main, line: lines.findIndex((text) => /^frame:\s+CALL/.test(text)) + 1 };
  });
  check(line > 0, "trajectory.s has no line 'frame: CALL'");
  await t.page.evaluate((f, l) => npchip.act().toggleBreak(f, l), file, line);
  await t.choose("Speed", "As fast as it goes");
  await t.press("Run");
  await t.until("the breakpoint stops the run", () => npchip.store.stop.value?.reason === "breakpoint");
  await still(t);
  const call = await t.page.evaluate(() => npchip.store.view.value?.address);
  const depth = () => t.page.evaluate(() => npchip.store.view.value?.stack.length);
  equal(await depth(), 0, "open calls at the breakpoint");
  await travel(t, "Step");
  equal(await depth(), 1, "open calls in the routine");
  await travel(t, "Step out");
  equal(await depth(), 0, "open calls after stepping out");
  await travel(t, "Step back");
  await t.press("Run");
  await t.until(
    "it stops at the breakpoint again",
    (at) => !npchip.store.running.value && npchip.store.view.value?.address === at,
    [call] as const,
  );
  const before = await t.page.evaluate(() => npchip.store.view.value?.instructions ?? 0);
  const after = await travel(t, "Step over");
  check(after > before + 10, `stepping over a call went from ${before} to ${after} instructions`);
  equal(await depth(), 0, "open calls after stepping over");
});

flow("write: who wrote this", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await assembling(t);
  await t.choose("Speed", "As fast as it goes");
  await t.press("Run");
  await ended(t);
  await t.page.evaluate(() =>
    npchip.act().whoWrote({ kind: "one", cell: { kind: "register", index: 11 }, row: 3, column: 4 }),
  );
  await t.message(/wrote it in frame \d+/, { timeout: 20_000 });
});

flow("write: a link holds the program, and opens it elsewhere", async (t) => {
  await openExample(t, "trajectory", "shapes_drawn");
  await assembling(t);
  await t.write(GOOD);
  await mistakes(t, "none");
  await t.press("Share");
  const box = await t.control("textbox", "Link");
  const link = await t.until("there is a link", (element) => (element as HTMLInputElement).value, [box] as const);
  check(link.includes("#code="), `the link is ${link.slice(0, 80)}`);
  await t.page.evaluate(() => localStorage.clear());
  await t.page.goto("about:blank");
  await t.open(link.slice(link.indexOf("#")));
  await t.until("the program of the link is there", (wanted) => {
    const { main, files } = npchip.store.project.value;
    return files[main] === wanted && npchip.store.clip.value;
  }, [GOOD] as const, { timeout: LOADING });
  check(!(await t.page.evaluate(() => npchip.store.running.value)), "the link ran by itself");
  await t.press("Run");
  equal(await ended(t), "frames-exhausted", "the end of the run");
});

flow("write: a damaged link gets a message and loses nothing", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await t.write(GOOD);
  await kept(t, GOOD);
  // The page is left while it loads Python, which Firefox calls an error of the service worker.
  t.watch.allow(/Failed to load .* A ServiceWorker intercepted the request/);
  for (const hash of ["#code=", "#code=%%%", "#code=AAAA", "#code=eyJ2IjoxfQ"]) {
    await t.page.goto("about:blank");
    await t.open(hash);
    await t.message(/link is damaged/, { timeout: LOADING });
    equal(await t.program(), GOOD, `the program after ${hash}`);
  }
});

flow("write: the browser keeps the program", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await t.write(GOOD);
  await kept(t, GOOD);
  await t.page.goto("about:blank");
  await t.open();
  await t.until("the kept program is there", (wanted) => {
    const { main, files } = npchip.store.project.value;
    return files[main] === wanted;
  }, [GOOD] as const, { timeout: LOADING });
});

flow("write: what was typed last is kept when the page goes", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await t.write(GOOD);
  await t.page.goto("about:blank"); // sooner than it is kept by the clock
  await t.open();
  await t.until("the kept program is there", (wanted) => {
    const { main, files } = npchip.store.project.value;
    return files[main] === wanted;
  }, [GOOD] as const, { timeout: LOADING });
});

flow("write: every program that gave way to an example can be opened again", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  const first = `${GOOD}; the first\n`;
  await t.write(first);
  const open = (main: string) =>
    t.until(`${main} is open`, (name) => npchip.store.project.value.main === name, [main] as const, { timeout: LOADING });
  await t.choose("Example", "edges");
  await open("edges.s");
  await t.write(`${GOOD}; the second\n`);
  await t.choose("Example", "imaging");
  await open("imaging.s");
  const example = await t.control("combobox", "Example");
  await example.evaluate((element) => {
    const select = element as HTMLSelectElement;
    select.value = [...select.querySelectorAll('[label="Your programs"] option')].map((each) => (each as HTMLOptionElement).value).at(-1)!;
    select.dispatchEvent(new Event("change", { bubbles: true }));
  });
  await open("trajectory.s");
  equal(await t.program(), first, "the program that was written first");
});

flow("write: two tabs do not overwrite each other's program", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await t.write(`${GOOD}; of one tab\n`);
  await kept(t, "of one tab");
  const other = await t.page.browserContext().newPage();
  await other.goto(t.job.url);
  await other.waitForFunction(() => npchip.store.view.value !== null, { timeout: LOADING });
  await other.evaluate(() => npchip.act().edit("trajectory.s", "; of the other tab"));
  await kept(t, "of the other tab");
  await t.page.bringToFront();
  await t.write(`${GOOD}; of one tab again\n`);
  await t.message(/open in another tab/);
  await kept(t, "of one tab again");
  const stored = await t.page.evaluate(() => localStorage.getItem("npchip.asides") ?? "");
  check(stored.includes("of the other tab"), "the other tab's program is lost");
  await other.close();
});

flow("write: a kept program that cannot be read is set apart", async (t) => {
  await t.page.evaluateOnNewDocument(() => {
    // As a page of a later version may have left it.
    if (location.protocol === "http:") localStorage.setItem("npchip.program", "{broken");
  });
  await t.open();
  await t.message(/cannot be read/, { timeout: LOADING });
  await t.press("Save");
  await t.control("button", "Save the kept program that could not be read");
  equal(await t.page.evaluate(() => localStorage.getItem("npchip.damaged")), "{broken", "the text");
});

flow("write: a full storage gets a message and loses nothing", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await t.page.evaluate(() => {
    let size = 1 << 22;
    for (let part = 0; size > 0; part += 1) {
      try {
        localStorage.setItem(`filler ${part}`, "x".repeat(size));
      } catch {
        size >>= 1;
      }
    }
  });
  const long = `${GOOD}${"; a long comment\n".repeat(1000)}`;
  await t.write(long);
  await t.message(/storage is full/);
  equal(await t.program(), long, "the program");
  await mistakes(t, "none");
  await t.press("Run");
  equal(await ended(t), "frames-exhausted", "the end of the run");
});

flow("write: the program can be saved and opened", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await t.write(GOOD);
  await t.until("the text is in the page", (wanted) => {
    const { main, files } = npchip.store.project.value;
    return files[main] === wanted;
  }, [GOOD] as const);
  await t.press("Save");
  const main = await t.page.evaluate(() => npchip.store.project.value.main);
  const { bytes } = await t.saved(() => t.press(`Save ${main}`));
  equal(bytes.toString(), GOOD, "the saved file");
});

flow("write: the source's expectations are checked", async (t) => {
  await openExample(t, "edges", "coin_slide");
  await assembling(t);
  const tab = await t.control("tab", "Checks");
  await tab.click();
  await t.page.evaluate(() => npchip.act().check());
  await t.until("there are verdicts", () => (npchip.store.verdicts.value?.length ?? 0) > 0, [], { timeout: LOADING });
  const wrong = await t.page.evaluate(() => npchip.store.verdicts.value?.filter((each) => !each.holds));
  equal(wrong, [], "the expectations that do not hold");
});

const ALARM = `.next:  LD      value, [pixel]
        CMP     value, #200
        JANY    HI, found
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     send
found:  MOV     state, #1
send:   OUT     0, state
`;

/** Check the program, and return what does not hold, as the page says it. */
async function missing(t: Session): Promise<string[]> {
  await t.page.evaluate(() => npchip.act().check());
  await t.until("there are verdicts", () => (npchip.store.verdicts.value?.length ?? 0) > 0, [], { timeout: LOADING });
  return t.page.evaluate(() => (npchip.store.verdicts.value ?? []).filter((each) => !each.holds).map((each) => each.found));
}

flow("write: a lesson says what is missing, and when it is done", async (t) => {
  await openExample(t, "edges", "coin_slide");
  await assembling(t);
  await t.choose("Example", "08 alarm");
  await t.until("the lesson is open", () => npchip.store.project.value.main === "alarm.s");
  await t.message(/is a lesson/);
  await mistakes(t, "none");
  const begun = await missing(t);
  check(begun.some((each) => each.includes("perhaps: nothing is sent yet")), `it says what to do: ${begun.join("; ")}`);
  const text = await t.program();
  await t.write(text.replace("        ; your program\n", ALARM));
  await mistakes(t, "none");
  equal(await missing(t), [], "what the solution lacks");
});
