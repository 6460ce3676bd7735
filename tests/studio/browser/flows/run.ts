/** Run, pause, reset, step and go back. */

import { check, equal } from "../driver/expect";
import { flow } from "../driver/flow";
import type { Session } from "../driver/session";
import { ended, instructions, mistakes, opened, openExample, still, travel } from "../driver/studio";

flow("run: the first picture moves and the table fills", async (t) => {
  await opened(t);
  equal(await ended(t), "frames-exhausted", "the end of the run");
  const frames = await t.page.evaluate(() => npchip.store.frameCount.value);
  const names = ["valid", "center_row", "center_col", "predicted_row", "predicted_col", "cycles"];
  await t.until(
    `the table has ${frames} rows`,
    (count) => document.querySelectorAll("[aria-label=Outputs] tbody tr").length >= Math.min(count, 10),
    [frames] as const,
  );
  const [heads] = await t.outputs();
  equal(heads?.slice(-names.length), names, "the heads of the table");
  await t.control("region", "Array");
});

flow("run: run, pause, run on, reset", async (t) => {
  await openExample(t, "trajectory", "city_night");
  await t.choose("Speed", "30 frames a second");
  await t.press("Run");
  await t.until("some frames have been run", () => npchip.store.frameCount.value >= 5);
  await t.press("Pause");
  await still(t);
  const paused = await instructions(t);
  const frames = await t.page.evaluate(() => npchip.store.frameCount.value);
  await t.press("Run");
  await t.until("it runs on", (was) => npchip.store.frameCount.value > was, [frames] as const);
  await t.press("Pause");
  await still(t);
  check((await instructions(t)) > paused, "the run did not go on where it was paused");
  await t.press("Reset");
  await t.until("the chip is reset", () => npchip.store.view.value?.instructions === 0);
  equal(await t.page.evaluate(() => npchip.store.frameCount.value), 0, "the frames after the reset");
});

flow("run: all speeds", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  const speeds = await (await t.control("combobox", "Speed")).evaluate((element) =>
    [...(element as HTMLSelectElement).options].map((option) => option.label),
  );
  check(speeds.length >= 3, "there are fewer than three speeds");
  for (const speed of speeds) {
    await t.press("Reset");
    await t.choose("Speed", speed);
    await t.press("Run");
    await t.until(`it runs at ${speed}`, () => (npchip.store.view.value?.instructions ?? 0) > 0);
    if (await t.page.evaluate(() => npchip.store.running.value)) await t.press("Pause");
    await still(t);
  }
  equal(await t.page.evaluate(() => npchip.store.pace.value), "max", "the last speed");
});

flow("run: step and step back", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  const state = () =>
    t.page.evaluate(() => {
      const view = npchip.store.view.value;
      return view && [view.address, view.cycles, [...view.registers], [...view.memory].slice(0, 9000)];
    });
  await t.press("Reset");
  const states = [];
  for (let count = 1; count <= 12; count += 1) {
    equal(await travel(t, "Step"), count, "instructions after a step");
    states.push(await state());
  }
  for (let count = 11; count >= 1; count -= 1) {
    equal(await travel(t, "Step back"), count, "instructions after a step back");
    equal(await state(), states[count - 1], `the chip after ${count} instructions`);
  }
});

flow("run: the table can be saved as CSV", async (t) => {
  await openExample(t, "trajectory", "coin_slide");
  await t.choose("Speed", "As fast as it goes");
  await t.press("Run");
  await ended(t);
  const { name, bytes } = await t.saved(async () => {
    await t.press("Save as CSV");
  });
  check(name.endsWith(".csv"), `the file is called ${name}`);
  const lines = bytes.toString().trim().split(/\r?\n/);
  const frames = await t.page.evaluate(() => npchip.store.frameCount.value);
  check(/valid,.*cycles/.test(lines.find((line) => line.includes("cycles")) ?? ""), "no line of names");
  check(lines.length > frames, `${lines.length} lines for ${frames} frames`);
});

const ENDLESS = "; spins\nframe:  EXPOSE\nspin:   JMP     spin\n";

/** Run an endless program which no limit of cycles ends. */
async function spinning(t: Session): Promise<void> {
  await openExample(t, "trajectory", "coin_slide");
  await t.page.evaluate(() => {
    const chip = npchip.chip();
    const load = chip.load.bind(chip);
    chip.load = (module, program) => load(module, program, 1e15);
  });
  await t.write(ENDLESS);
  await t.until("the text is in the page", (wanted) => {
    const { main, files } = npchip.store.project.value;
    return files[main] === wanted;
  }, [ENDLESS] as const);
  await t.press("Run", { timeout: 60_000 });
  await t.until("it has spun for longer than the limit of the page", () =>
    npchip.store.running.value && (npchip.store.view.value?.cycles ?? 0) > 50_000_000,
  );
}

/** Mend the endless program, and run it to its end. */
async function mend(t: Session): Promise<void> {
  equal(await t.program(), ENDLESS, "the program after the stop");
  await t.write(ENDLESS.replace("spin:   JMP     spin", "        JMP     frame"));
  await mistakes(t, "none");
  await t.press("Run", { timeout: 60_000 });
  equal(await ended(t), "frames-exhausted", "the end of the mended program");
}

flow("run: Pause ends an endless program, and nothing is lost", async (t) => {
  await spinning(t);
  await t.press("Pause");
  await still(t, 10_000);
  equal(await t.page.evaluate(() => npchip.store.view.value?.ended), false, "whether the run is over");
  await mend(t);
});

flow("run: Pause ends a chip that does not answer, and nothing is lost", async (t) => {
  await spinning(t);
  await t.page.evaluate(() => {
    const chip = npchip.chip();
    const pause = chip.pause.bind(chip);
    chip.pause = () => {
      chip.pause = pause; // it does not hear it once
    };
  });
  await t.press("Pause");
  await t.message(/did not answer/);
  await still(t, 10_000);
  await mend(t);
});
