/** The machine that programs are compiled for. */

import type { MachineChoice } from "../protocol";
import { clip, machine, running } from "../store";
import { bringUp, stale } from "./chip";
import { chooseBundled, chosenClip, frameSize } from "./clips";
import { compileNow } from "./compile";
import { say, sayError } from "./say";

/** Use another machine; a machine file that cannot be read changes nothing. */
export async function chooseMachine(wanted: MachineChoice): Promise<void> {
  const before = machine.value;
  running.value = false;
  machine.value = wanted;
  const made = await compileNow();
  const broken = made?.diagnostics.find((each) => each.place?.file === wanted.name);
  if (wanted.text !== undefined && (!made || broken)) {
    machine.value = before;
    await compileNow();
    if (broken) sayError(new Error(`${wanted.name}: ${broken.message}`));
    return;
  }
  stale.value = true;
  if (!(await bringUp())) return;
  await refit();
  say(`Machine: ${made?.program?.machine.summary ?? wanted.name}`);
}

/** A clip of another size than the machine's is read again, if it is a bundled one. */
async function refit(): Promise<void> {
  const size = frameSize();
  const now = clip.value;
  if (now === null || now === "live" || (now.rows === size.rows && now.cols === size.cols)) return;
  if (["own", "scene"].includes(chosenClip.value)) {
    clip.value = null;
    chosenClip.value = "";
    sayError(new Error(`This machine takes frames of ${size.rows} × ${size.cols}: open your clip again`));
  } else await chooseBundled(chosenClip.value);
}
