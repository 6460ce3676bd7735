/** Flows on the stand-in page: they show that the driver sees what it should. */

import { check, equal } from "./expect";
import { flow } from "./flow";
import { focused, misfits, violations } from "./looks";
import { give } from "./studio";

flow("standin: reads and presses", async (t) => {
  await t.open();
  equal(await t.outputs(), [["valid", "cycles"]], "the table before the run");
  await t.press("Run");
  equal(await t.message(/frame/), "1 frame", "the message");
  equal(await t.outputs(), [["valid", "cycles"], ["1", "1692"]], "the table after the run");
  await t.write("EXPOSE\n  HALT");
  const editor = await t.control("textbox", "Program");
  equal(await editor.evaluate((element) => element.innerText.trim()), "EXPOSE\n  HALT", "the text");
});

flow("standin: sees the camera", async (t) => {
  await t.open();
  await t.choose("Clip", "Camera");
  equal(await t.message(/camera/), "camera live", "the message");
});

flow("standin: has a camera of 30 frames a second", async (t) => {
  await t.open();
  const { frames, seconds } = await t.page.evaluate(async () => {
    const video = document.createElement("video");
    video.srcObject = await navigator.mediaDevices.getUserMedia({ video: { frameRate: 30 } });
    await video.play();
    const next = () => new Promise<number>((done) => video.requestVideoFrameCallback(done));
    const start = await next();
    let [now, count] = [start, 0];
    for (; now - start < 2000; count += 1) now = await next();
    return { frames: count, seconds: (now - start) / 1000 };
  });
  check(frames / seconds > 28, `the camera gave ${frames} frames in ${seconds.toFixed(2)} s`);
});

flow("standin: takes files", async (t) => {
  await t.open();
  await give(t, "Files", t.parameter("paths"));
  equal(await t.message(/:/), "a.txt: first, b.txt: second", "what the page reads");
});

flow("standin: saves", async (t) => {
  await t.open();
  const { name, bytes } = await t.saved(() => t.press("Save"));
  equal([name, bytes.toString()], ["outputs.csv", "valid,cycles\n"], "the file");
});

flow(
  "standin: prefers dark and still",
  async (t) => {
    await t.open();
    const asked = ["(prefers-color-scheme: dark)", "(prefers-reduced-motion: reduce)"];
    for (const query of asked) {
      check(await t.page.evaluate((q) => matchMedia(q).matches, query), `the page has no ${query}`);
    }
    equal(await t.page.evaluate(() => [innerWidth, innerHeight]), [360, 740], "the size");
  },
  { theme: "dark", still: true, width: 360, height: 740 },
);

flow("standin: fits everyone", async (t) => {
  await t.open();
  equal(await violations(t), [], "what axe finds");
  equal(await misfits(t), [], "what is too small or too wide");
  await t.page.keyboard.press("Tab");
  const now = await focused(t);
  equal([now?.name, now?.visible, now?.inside], ["Run", true, true], "the focus");
});

// ---- what must fail

flow("standin: has little contrast", async (t) => {
  await t.open();
  await t.page.evaluate(() => {
    document.querySelector("h1")!.style.color = "#ccc";
  });
  equal(await violations(t), [], "what axe finds");
});

flow("standin: has a small button and is too wide", async (t) => {
  await t.open();
  await t.page.evaluate(() => {
    Object.assign(document.querySelector<HTMLElement>("#run")!.style, { height: "20px", minHeight: 0 });
    document.querySelector("h1")!.style.width = "2000px";
  });
  equal(await misfits(t), [], "what is too small or too wide");
});

flow("standin: hides the focus", async (t) => {
  await t.open();
  await t.page.evaluate(() => {
    document.querySelector<HTMLElement>("#run")!.style.outline = "none";
  });
  await t.page.keyboard.press("Tab");
  check((await focused(t))?.visible, "the focus cannot be seen");
});

flow("standin: has no such button", async (t) => {
  await t.open();
  await t.press("Fly", { timeout: 500 });
});

flow("standin: logs an error", async (t) => {
  await t.open();
  await t.page.evaluate(() => console.error("on purpose"));
});

flow("standin: throws", async (t) => {
  await t.open();
  await t.page.evaluate(() => void setTimeout(() => Promise.reject(new Error("on purpose"))));
  await t.until("a task has passed", () => new Promise((done) => setTimeout(() => done(true), 50)));
});

flow("standin: has a worker that throws", async (t) => {
  await t.open();
  await t.page.evaluate(() => {
    const worker = new Worker("worker.js");
    return new Promise((done) => {
      worker.onerror = done;
    }).then(() => null);
  });
});

flow("standin: asks another host", async (t) => {
  await t.open();
  await t.page.evaluate(() => fetch("http://other.example/").catch(() => null));
});

flow("standin: breaks the policy", async (t) => {
  await t.open();
  await t.page.evaluate(() => {
    const image = new Image();
    image.src = "http://third.example/picture.png";
    return new Promise((done) => {
      image.onerror = done;
    }).then(() => null);
  });
});

flow(
  "standin: never ends",
  async (t) => {
    await t.open();
    await t.page.evaluate(() => new Promise(() => null));
  },
  { seconds: 1 },
);
