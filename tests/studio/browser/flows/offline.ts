/** The page without its server. */

import { equal } from "../driver/expect";
import { flow } from "../driver/flow";
import { assembling, ended, LOADING, mistakes, moving, opened, openExample } from "../driver/studio";

const GOOD = "frame:  EXPOSE\n        JMP     frame\n";

flow("offline: the page goes on and opens again without its server", async (t) => {
  await opened(t);
  await assembling(t);
  await t.until(
    "the service worker keeps the page",
    async () => (await navigator.serviceWorker.ready).active?.state === "activated",
    [],
    { timeout: LOADING },
  );
  // The second visit is the worker's, which then has all that the page needs.
  await t.open();
  await assembling(t);
  // The server may answer once more before it is gone.
  t.watch.allow(/ERR_CONNECTION_REFUSED|NetworkError|Failed to fetch|status of 404/);
  process.kill(t.parameter<number>("server"));
  await t.until(
    "nothing answers at its address",
    // The service worker keeps no such file, so this asks the server.
    (url) => fetch(`${url}?${Math.random()}`, { cache: "no-store" }).then(() => false, () => true),
    [new URL("/gone", t.job.url).href] as const,
  );
  await t.write(GOOD);
  await mistakes(t, "none");
  await t.press("Run");
  equal(await ended(t), "frames-exhausted", "the end of the run without a server");
  await t.choose("Example", "edges");
  await t.until("an example opens", () => npchip.store.program.value?.name === "edges");
  await t.page.goto("about:blank");
  await openExample(t, "trajectory", "coin_slide");
  await t.press("Run");
  await moving(t);
  await assembling(t);
  await t.write(GOOD);
  await mistakes(t, "none");
}, { fresh: true });
