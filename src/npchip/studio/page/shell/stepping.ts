/** Brings the stepping form to the chip: it takes longer to make than all else of an edit. */

import type { Compiled } from "../protocol";
import { wholeOf } from "./compile";
import { chip } from "./parts";
import { textOf } from "./say";

type Module = NonNullable<Compiled["module"]>;

/** Another key is likely within this time, and should not wait for the compiler; in milliseconds. */
const LULL = 250;

let hurry: () => void = () => undefined;

/** Complete the program that was put into the chip, once nothing else is to be compiled. */
export async function complete(module: Module, isThere: () => boolean): Promise<void> {
  const whole = wholeOf(module);
  if (!whole) return;
  await new Promise<void>((resolve) => {
    hurry = resolve;
    setTimeout(resolve, LULL);
  });
  if (!isThere()) return;
  try {
    const made = await whole();
    if (isThere()) await chip().stepping(made);
  } catch (fault) {
    if (isThere()) await chip().stepping(null, textOf(fault));
  }
}

/** The reader wants to step now. */
export function stepNow(): void {
  hurry();
}
