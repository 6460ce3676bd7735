/**
 * Run flows in one browser. A line of JSON on the standard input asks for a flow, a line on the
 * standard output says what came of it; the first line of the input is the `Setup`.
 */

import { mkdir, mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import type { Browser, BrowserContext, Page } from "puppeteer-core";
import { launch, type Setup } from "./browsers";
import { type Flow, flows } from "./flow";
import { type Job, Session } from "./session";
import { Watch } from "./watch";

const SECONDS = 90;

interface Answer {
  flow: string;
  ok: boolean;
  error: string;
  report: Record<string, unknown>;
}

class Runner {
  #browser: Browser | null = null;
  #variant = "";
  /** What flows share which may find the page in the browser's caches: to load it anew takes seconds. */
  #shared: BrowserContext | null = null;

  constructor(readonly setup: Setup) {}

  async run(job: Job): Promise<Answer> {
    const flow = flows.get(job.flow);
    if (!flow) return { flow: job.flow, ok: false, error: "there is no such flow", report: {} };
    await mkdir(job.folder, { recursive: true });
    const browser = await this.#started(flow);
    const context = (flow.fresh ? null : this.#shared) ?? (await this.#context(browser));
    if (!flow.fresh) this.#shared = context;
    if (this.setup.kind === "chromium") {
      await context.overridePermissions(new URL(job.url).origin, ["clipboard-read"]);
    }
    const page = await context.newPage();
    let ok = false;
    try {
      if (!flow.fresh) await this.#forget(page, job.url);
      const answer = await this.#inside(page, flow, job);
      ok = answer.ok;
      return answer;
    } finally {
      // After a mistake the next flow begins with nothing.
      const keeps = ok && context === this.#shared;
      if (!keeps && context === this.#shared) this.#shared = null;
      // A page that never lets go goes with its browser.
      await within(20, keeps ? page.close() : context.close()).catch(() => this.close());
    }
  }

  async close(): Promise<void> {
    const browser = this.#browser;
    this.#browser = this.#shared = null;
    await browser?.close().catch(() => browser.process()?.kill("SIGKILL"));
  }

  /** Firefox learns what a reader prefers when it starts, so such flows get another one. */
  async #started(flow: Flow): Promise<Browser> {
    const firefox = this.setup.kind === "firefox";
    const variant = firefox ? `${flow.theme ?? "light"} ${flow.still ?? false}` : "";
    if (!this.#browser?.connected || variant !== this.#variant) {
      await this.close();
      this.#browser = await launch(this.setup, flow);
      this.#variant = variant;
    }
    return this.#browser;
  }

  #context(browser: Browser): Promise<BrowserContext> {
    if (this.setup.kind === "firefox") return browser.createBrowserContext();
    const downloadPath = this.setup.downloads;
    return browser.createBrowserContext({ downloadBehavior: { policy: "allow", downloadPath } });
  }

  /** Forget what the page has kept in flows before; a new tab has kept nothing for itself. */
  async #forget(page: Page, url: string): Promise<void> {
    if (this.setup.kind === "chromium") {
      const session = await page.createCDPSession();
      const { origin } = new URL(url);
      await session.send("Storage.clearDataForOrigin", { origin, storageTypes: "local_storage" });
      await session.detach();
    } else {
      await page.goto(new URL("icon.svg", url).href); // of its origin, and there is nothing to it
      await page.evaluate(() => localStorage.clear());
    }
  }

  async #inside(page: Page, flow: Flow, job: Job): Promise<Answer> {
    const watch = await Watch.over(page, job.url);
    const { kind, downloads, axe } = this.setup;
    const session = new Session(page, kind, job, flow, watch, downloads, axe);
    let error = "";
    try {
      await page.setViewport({ width: flow.width ?? 1280, height: flow.height ?? 720 });
      if (kind === "chromium") {
        await page.emulateMediaFeatures([
          { name: "prefers-color-scheme", value: flow.theme ?? "light" },
          { name: "prefers-reduced-motion", value: flow.still ? "reduce" : "no-preference" },
        ]);
      }
      await within(flow.seconds ?? SECONDS, flow.run(session));
    } catch (thrown) {
      error = told(thrown);
    }
    const { faults } = watch;
    if (faults.length > 0) error += `${error && "\n"}the page has ${faults.join("\n")}`;
    if (error) await this.#leave(page, watch, job, error);
    return { flow: job.flow, ok: !error, error, report: session.report };
  }

  /** Leave behind what helps to find out why. */
  async #leave(page: Page, watch: Watch, job: Job, error: string): Promise<void> {
    await writeFile(join(job.folder, "error.txt"), `${error}\n`);
    await writeFile(join(job.folder, "console.txt"), `${watch.log.join("\n")}\n`);
    await within(20, page.screenshot({ path: join(job.folder, "page.png") })).catch(() => null);
    await within(20, page.content())
      .then((text) => writeFile(join(job.folder, "page.html"), text))
      .catch(() => null);
  }
}

/** Return what a promise gives, or fail after some seconds. */
async function within<T>(seconds: number, promise: Promise<T>): Promise<T> {
  let timer: NodeJS.Timeout | undefined;
  const late = new Promise<never>((_, reject) => {
    const fail = () => reject(new Error(`was not done within ${seconds} s`));
    timer = setTimeout(fail, 1000 * seconds);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

function told(thrown: unknown): string {
  if (!(thrown instanceof Error)) return String(thrown);
  const lines = (thrown.stack ?? thrown.message).split("\n");
  const own = lines.filter((line) => !/^\s+at .*(node:|puppeteer)/.test(line));
  return own.slice(0, 12).join("\n") + (thrown.cause ? `\n  because of ${thrown.cause}` : "");
}

async function main(): Promise<void> {
  const lines = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
  const first = await lines.next();
  if (first.done) return;
  const setup = JSON.parse(first.value) as Omit<Setup, "downloads">;
  const downloads = await mkdtemp(join(tmpdir(), "npchip-downloads-"));
  const runner = new Runner({ ...setup, downloads });
  try {
    for (let line = await lines.next(); !line.done; line = await lines.next()) {
      const job = JSON.parse(line.value) as Job;
      const answer = await runner.run(job).catch((thrown: unknown): Answer => {
        return { flow: job.flow, ok: false, error: told(thrown), report: {} };
      });
      process.stdout.write(`${JSON.stringify(answer)}\n`);
    }
  } finally {
    await runner.close();
    await rm(downloads, { recursive: true, force: true });
  }
}

void main();
