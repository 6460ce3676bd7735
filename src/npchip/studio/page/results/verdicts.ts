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

/** Say how many expectations hold; what the panel says the status line says, too. */
export function summary(all: readonly Verdict[] | null, some: boolean): string {
  if (!all) return some ? "Not checked yet." : "This program has no expectations.";
  if (!all.length) return "There was nothing to check.";
  const failing = all.filter(({ holds }) => holds === false).length;
  const judged = all.filter(({ holds }) => holds !== null).length;
  const left = all.length - judged;
  const said = [
    failing ? `✗ ${failing} of ${judged} expectations fail.` : judged ? `✓ All ${judged} expectations hold.` : "",
    left ? `– ${left} run${left === 1 ? " needs" : "s need"} npchip test.` : "",
  ];
  return said.filter(Boolean).join(" ");
}
