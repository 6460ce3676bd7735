/** Jobs that end in another order than they began. Prints what the status line shows, as JSON. */

import { begin, during } from "../../../src/npchip/studio/page/control/jobs";
import { message, progress } from "../../../src/npchip/studio/page/store";

const shown: (string | null)[] = [];
const look = (): void => {
  const work = progress.value;
  shown.push(work && `${work.text} ${work.share} ${work.cancel ? "Cancel" : "-"}`);
};
const control = new AbortController();
const stopped = new Promise<never>((_, reject) => {
  control.signal.addEventListener("abort", () => reject(control.signal.reason as Error));
});
const video = during("Reading", async (job) => {
  job.tell(0.5);
  await stopped;
}, () => control.abort());
look();
const search = begin("Looking back");
search.tell(0.25);
look();
search.end();
search.tell(0.75);
look();
await during("Fetching", async () => look());
look();
progress.value?.cancel?.();
await video;
look();
const before = message.value;
await during("Failing", () => Promise.reject(new Error("it failed")));
look();
console.log(JSON.stringify({ shown, silent: before.text === "", failed: message.value }));
