/** The camera: live frames, how late they are shown, and what happens without one. */

import { check, equal } from "../driver/expect";
import { flow } from "../driver/flow";
import type { Session } from "../driver/session";
import { openExample, still } from "../driver/studio";

/** Count how often the page asks for a camera; with a name of an error, refuse it. */
async function overCamera(t: Session, refusal: string | null): Promise<void> {
  await t.page.evaluateOnNewDocument((error) => {
    globalThis.asked = 0;
    const { mediaDevices } = navigator;
    if (!mediaDevices) return; // about:blank is no place for cameras
    const ask = mediaDevices.getUserMedia.bind(mediaDevices);
    mediaDevices.getUserMedia = (wanted) => {
      globalThis.asked += 1;
      return error ? Promise.reject(new DOMException("no", error)) : ask(wanted);
    };
  }, refusal);
}

declare global {
  var asked: number;
  var captured: number;
}

flow("camera: a link never starts it", async (t) => {
  await overCamera(t, null);
  await t.page.evaluateOnNewDocument(() => {
    // What a link, or an earlier visit, could try.
    const text = JSON.stringify({
      project: { main: "p.s", files: { "p.s": "frame: EXPOSE\n JMP frame\n" } },
      clip: "camera",
      machine: "default",
    });
    if (location.protocol === "http:") localStorage.setItem("npchip.program", text);
  });
  for (const rest of ["", "#example=edges&clip=camera", "#example=edges&clip=Camera"]) {
    await t.page.goto("about:blank");
    await t.open(rest);
    await t.until("the page is there", () => npchip.store.project.value.files[npchip.store.project.value.main]);
    await t.control("button", "Run");
    await t.press("Run").catch(() => null);
    equal(await t.page.evaluate(() => globalThis.asked), 0, `cameras asked for with '${rest}'`);
  }
});

flow("camera: frames flow", async (t) => {
  await openExample(t, "edges", "coin_slide");
  await t.choose("Clip", "Camera");
  await t.until("the camera is on", () => npchip.store.clip.value === "live");
  await t.press("Run");
  await t.until("frames come", () => npchip.store.frameCount.value >= 20);
  await t.press("Pause");
  await still(t);
  const frames = await t.page.evaluate(() => npchip.store.frameCount.value);
  await t.press("Run");
  await t.until("frames come again", (was) => npchip.store.frameCount.value >= was + 10, [frames] as const);
  // Another clip turns the camera off.
  await t.choose("Clip", "coin_slide");
  await t.until("the clip is there", () => npchip.store.clip.value !== "live");
});

flow("camera: refused, missing or busy, it gets a message and changes nothing", async (t) => {
  const said: string[] = [];
  for (const error of ["NotAllowedError", "NotFoundError", "NotReadableError"]) {
    await t.page.goto("about:blank");
    await overCamera(t, error);
    await openExample(t, "edges", "coin_slide");
    await t.choose("Clip", "Camera");
    said.push(await t.message(/Problem.*camera/is));
    equal(await t.page.evaluate(() => globalThis.asked), 1, "cameras asked for");
    check(await t.page.evaluate(() => npchip.store.clip.value !== "live"), "the clip is the camera");
    const box = await t.control("combobox", "Clip");
    const shown = await box.evaluate((element) => (element as HTMLSelectElement).value);
    equal(shown, "coin_slide", "what the box Clip shows");
    await t.press("Run");
    await t.until("the old clip runs", () => npchip.store.frameCount.value > 0);
  }
  equal(new Set(said).size, said.length, "number of different messages");
});

/**
 * Let a program run on the camera for some seconds, and report for the test to judge: frames that
 * the camera gave and that were processed, and how late each was shown. Late is the time from the
 * capture of a frame to the first picture that the browser draws after the program has completed it.
 */
async function film(t: Session, program: string, seconds: number): Promise<void> {
  await t.page.evaluateOnNewDocument(() => {
    // When the newest picture was captured, as the page learns it.
    const { prototype } = HTMLVideoElement;
    const ask = prototype.requestVideoFrameCallback;
    prototype.requestVideoFrameCallback = function (this: HTMLVideoElement, hear) {
      return ask.call(this, (now, data) => {
        globalThis.captured = data.captureTime ?? now;
        hear(now, data);
      });
    };
  });
  await openExample(t, program, "coin_slide");
  await t.choose("Clip", "Camera");
  await t.until("the camera is on", () => npchip.store.clip.value === "live");
  await t.press("Run");
  await t.until("frames come", () => npchip.store.frameCount.value >= 10);
  const measured = await t.page.evaluate(async (duration) => {
    const chip = npchip.chip();
    const feed = chip.feed.bind(chip);
    const late: number[] = [];
    let given = 0;
    let dropped = 0;
    chip.feed = async (frame) => {
      const { captured } = globalThis;
      given += 1;
      const end = await feed(frame);
      if (end === "dropped") dropped += 1;
      else requestAnimationFrame(() => late.push(performance.now() - captured));
      return end;
    };
    const [start, first] = [performance.now(), npchip.store.frameCount.value];
    await new Promise((resolve) => setTimeout(resolve, duration));
    const [end, last] = [performance.now(), npchip.store.frameCount.value];
    chip.feed = feed;
    late.sort((a, b) => a - b);
    return { given, dropped, processed: last - first, seconds: (end - start) / 1000, late };
  }, 1000 * seconds);
  const { late, ...counts } = measured;
  Object.assign(t.report, counts, {
    latest: late.at(-1),
    median: late[late.length >> 1],
    over: late.filter((each) => each > 100).length,
  });
}

flow("camera: five seconds", (t) => film(t, t.parameter("program"), 5));

flow("camera: a minute", (t) => film(t, t.parameter("program"), 60), { seconds: 150 });
