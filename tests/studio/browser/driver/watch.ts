/** Watch a page: whatever it complains of, and whatever it asks of another host, is a mistake. */

import type { Page } from "puppeteer-core";

const VIOLATION = "Content security policy: ";

/** Everything that a page said; `faults` are what no page may do. */
export class Watch {
  readonly log: string[] = [];
  readonly #faults: string[] = [];
  readonly #allowed: RegExp[] = [];
  readonly #broken = new AbortController();
  readonly #host: string;

  private constructor(url: string) {
    this.#host = new URL(url).host;
  }

  /** Watch a page from before it loads anything. */
  static async over(page: Page, url: string): Promise<Watch> {
    const watch = new Watch(url);
    page.on("console", (message) => {
      const line = `${message.type()}: ${message.text()}`;
      watch.log.push(line);
      if (message.type() === "error" || message.type() === "assert") watch.#fault(line);
    });
    page.on("pageerror", (error) => {
      watch.#fault(`uncaught: ${error instanceof Error ? (error.stack ?? error.message) : error}`);
    });
    page.on("request", (request) => watch.#request(request.url()));
    page.on("error", (error) => watch.#fault(`the page crashed: ${error.message}`));
    await page.evaluateOnNewDocument((violation) => {
      // No browser says what a worker throws if the page listens to the worker's errors.
      const Plain = globalThis.Worker;
      globalThis.Worker = class extends Plain {
        constructor(url: string | URL, options?: WorkerOptions) {
          super(url, options);
          this.addEventListener("error", (event) => console.error(`in a worker: ${event.message}`));
        }
      };
      document.addEventListener("securitypolicyviolation", (event) => {
        console.error(`${violation}${event.violatedDirective} ${event.blockedURI}`);
      });
    }, VIOLATION);
    return watch;
  }

  /** Let faults pass that a flow brings about, such as requests to a server that was stopped. */
  allow(pattern: RegExp): void {
    this.#allowed.push(pattern);
  }

  /** What the page did that it may not do. */
  get faults(): string[] {
    return this.#faults.filter((fault) => !this.#allowed.some((pattern) => pattern.test(fault)));
  }

  /** Aborted at the first fault: what is waited for may never come. */
  get broken(): AbortSignal {
    return this.#broken.signal;
  }

  #request(url: string): void {
    const { protocol, host } = new URL(url);
    const own = ["data:", "blob:", "about:"].includes(protocol) || host === this.#host;
    if (!own) this.#fault(`asked another host: ${url}`);
  }

  #fault(line: string): void {
    this.log.push(line);
    this.#faults.push(line);
    if (this.faults.length > 0) this.#broken.abort(new Error("the page is at fault"));
  }
}
