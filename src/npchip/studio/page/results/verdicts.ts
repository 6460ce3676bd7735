/** Groups the verdicts on expectations, and sums them up. */

import type { Verdict } from "../protocol";

/** The verdicts on a run on a machine. */
export interface RunGroup {
  name: string;
  verdicts: Verdict[];
}

/** Return the verdicts by run and machine, in their order. */
export function groups(all: readonly Verdict[]): RunGroup[] {
  const found = new Map<string, RunGroup>();
  for (const verdict of all) {
    const name = `${verdict.run} on ${verdict.machine}`;
    let group = found.get(name);
    if (!group) found.set(name, (group = { name, verdicts: [] }));
    group.verdicts.push(verdict);
  }
  return [...found.values()];
}

/** Say how many expectations hold. */
export function summary(all: readonly Verdict[] | null, some: boolean): string {
  if (!all) return some ? "Not checked yet." : "This program has no expectations.";
  if (!all.length) return "There was nothing to check.";
  const held = all.filter((verdict) => verdict.holds).length;
  if (held === all.length) return `✓ All ${held} expectations hold.`;
  return `✗ ${all.length - held} of ${all.length} expectations fail.`;
}
