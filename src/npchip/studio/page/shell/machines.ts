/** The machine that programs are compiled for. */

import { effect, untracked } from "@preact/signals";
import type { MachineChoice } from "../protocol";
import { machine, program } from "../store";
import { bringUp, halt, run } from "./chip";
import { frameSize, refit } from "./clips";
import { compileNow } from "./compile";
import { say, sayError } from "./say";

/** Use another machine; a machine file that cannot be read changes nothing. */
export async function chooseMachine(wanted: MachineChoice): Promise<void> {
  const before = machine.value;
  const ran = await halt();
  machine.value = wanted;
  const made = await compileNow();
  const broken = made?.diagnostics.find((each) => each.place?.file === wanted.name);
  if (wanted.text !== undefined && (!made || broken)) {
    machine.value = before;
    await compileNow();
    if (broken) sayError(new Error(`${wanted.name}: ${broken.message}`));
    return;
  }
  if (!(await bringUp())) return;
  if (ran) await run();
  say(`Machine: ${made?.program?.machine.summary || wanted.name}`);
}

/** Let the clip and the camera have the size that the machine in the chip takes. */
export function clipFollowsMachine(): void {
  let size = { rows: 0, cols: 0 };
  effect(() => {
    if (!program.value) return;
    const now = untracked(frameSize);
    if (now.rows === size.rows && now.cols === size.cols) return;
    size = now;
    void refit().catch(sayError);
  });
}
