/** A run from the beginning to its end, as the JSON of a run has it. */

import type { RunDocument } from "../protocol";
import { Columns, documents } from "./columns";
import type { Sink } from "./core";
import { Forward } from "./forward";
import type { Forms } from "./description";
import { type Breathe, Past, SLICE } from "./past";
import type { Source } from "./source";
import { Watch } from "./conditions";

export async function wholeRun(
  forms: Forms,
  source: Source,
  limit: number,
  breathe: Breathe,
): Promise<RunDocument> {
  const { about } = forms.run;
  const setups = new Columns(about);
  const columns = new Columns(about);
  const sink: Sink = {
    frame(index, cycles, instructions, sends) {
      // The stepping form repeats frames that the run form has done.
      const into = index < 0 ? setups : columns;
      if (index < 0 ? !into.count : index === into.count) into.add(sends, cycles, instructions);
    },
    frames: (index, alike) => columns.addAlike(alike, columns.count - index),
  };
  const past = new Past(forms, limit, source, sink);

  const sprinter = past.sprinter();
  let pause = sprinter.sprint(SLICE);
  while (pause === "held") {
    if (await breathe()) throw new Error("the run was stopped");
    pause = sprinter.sprint(SLICE);
  }
  const chip = past.handover(sprinter, pause, null);
  const way = new Forward(chip, new Watch(chip, []), {});
  while (way.slice(SLICE) === "slice") if (await breathe()) throw new Error("the run was stopped");

  const { ended } = chip;
  if (!ended) throw new Error("the run came to no end");
  const isComplete = ended.status === "halted" || ended.status === "frames-exhausted";
  if (!isComplete) {
    const isReadable = !chip.broken && !chip.sends.broken();
    const into = setups.count ? columns : setups;
    into.add(chip.sends, chip.frameCycles, chip.frameInstructions, null, isReadable);
  }
  const frames = documents(columns.take());
  const [setup] = documents(setups.take());
  if (!setup) throw new Error("the run has no beginning");
  if (!isComplete) (frames.at(-1) ?? setup).complete = false;
  const all = [setup, ...frames];
  return {
    status: ended.status,
    ...(ended.error && { error: ended.error }),
    instructions: all.reduce((sum, frame) => sum + frame.instructions, 0),
    cycles: all.reduce((sum, frame) => sum + frame.cycles, 0),
    setup,
    frames,
  };
}
