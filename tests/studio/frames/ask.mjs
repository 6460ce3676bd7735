/**
 * Reads questions from its input, a line of JSON each, and writes the answers.
 *
 * Arguments: the bundled probe, `node`, `chrome` or `firefox`, the browser's path, where
 * puppeteer-core lies, and a folder to serve beside the page.
 */

import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

const [probe, kind, executablePath, puppeteerPath, folder] = process.argv.slice(2);
const source = await readFile(probe, "utf-8");

/** Return a function that answers a question, and one that ends the engine. */
async function start() {
  if (kind === "node") {
    await import(pathToFileURL(probe).href);
    return [globalThis.probe, async () => undefined];
  }
  const server = createServer(async (request, response) => {
    if (request.url === "/") {
      response.setHeader("content-type", "text/html");
      response.end("<!doctype html><title>Frames</title><script src=probe.js></script>");
    } else if (request.url === "/probe.js") {
      response.setHeader("content-type", "text/javascript");
      response.end(source);
    } else {
      const data = await readFile(`${folder}${request.url}`).catch(() => null);
      response.statusCode = data ? 200 : 404;
      response.end(data);
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const { default: puppeteer } = await import(pathToFileURL(puppeteerPath).href);
  const browser = await puppeteer.launch({
    browser: kind,
    executablePath,
    headless: true,
    args:
      kind === "chrome"
        ? ["--no-sandbox", "--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream"]
        : [],
    extraPrefsFirefox: {
      "media.navigator.streams.fake": true,
      "media.navigator.permission.disabled": true,
    },
  });
  const page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  const ask = (question) => page.evaluate((asked) => globalThis.probe(asked), question);
  return [ask, () => browser.close().finally(() => server.close())];
}

const [ask, end] = await start();
for await (const line of createInterface({ input: process.stdin })) {
  process.stdout.write(`${JSON.stringify({ value: await ask(JSON.parse(line)) })}\n`);
}
await end();
process.exit(0);
