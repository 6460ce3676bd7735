/** Chooses clips in the player while others are on their way. Prints what came of it, as JSON. */

import { allow, settled, streams } from "./playing";
import { choosePage, chooseCamera, chooseFiles, open, source } from "../../../src/npchip/studio/page/player/play";
import { clip, progress } from "../../../src/npchip/studio/page/store";

const found: Record<string, unknown> = {};
const lights = (): boolean[] => streams.splice(0).map(({ on }) => on);
const now = (): unknown[] => [source.value, clip.value === "live" ? "live" : clip.value?.name];

await open();

const twice = [chooseCamera(), chooseCamera()];
await settled();
await allow();
await allow();
await Promise.all(twice);
found.twice = { lights: lights(), now: now() };
await choosePage();

const late = chooseCamera();
await settled();
await choosePage();
await allow();
await late;
found.late = { lights: lights(), now: now() };

/** A file that is read when the test says. */
let give: (bytes: ArrayBuffer) => void = () => undefined;
const slow = (name: string): File => {
  const file = new File([], name);
  const bytes = new Promise<ArrayBuffer>((resolve) => (give = resolve));
  return Object.assign(file, { arrayBuffer: () => bytes, slice: () => ({ arrayBuffer: () => bytes, stream: () => new Blob([]).stream() }) });
};
const reading = chooseFiles([slow("long.npy")]);
await settled();
found.cancel = typeof progress.value?.cancel;
await choosePage();
give(new ArrayBuffer(4));
await reading;
found.reading = { now: now(), progress: progress.value };
console.log(JSON.stringify(found));
process.exit(0);
