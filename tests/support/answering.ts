/** Answers what a test asks: a line of JSON in, a line of JSON out; `page_code.py` asks. */

import { createInterface } from "node:readline";

/** Answer every line of the input, then end the process. */
export async function answering(answer: (question: any) => unknown): Promise<void> {
  for await (const line of createInterface({ input: process.stdin })) {
    let told: unknown;
    try {
      told = { value: (await answer(JSON.parse(line))) ?? null };
    } catch (fault) {
      told = { error: (fault as Error).message, stack: (fault as Error).stack };
    }
    process.stdout.write(`${JSON.stringify(told)}\n`);
  }
  process.exit(0);
}
