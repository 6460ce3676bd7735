// Opens an exported page from disk in a browser, uses it as a reader does, and prints what it found.

import { readFileSync } from "node:fs";

const [, , kind, executablePath, puppeteerFile, axeFile, page, clip] = process.argv;
const { default: puppeteer } = await import(puppeteerFile);

const browser = await puppeteer.launch({
  browser: kind === "firefox" ? "firefox" : "chrome",
  executablePath,
  headless: true,
  args: kind === "firefox" ? [] : ["--no-sandbox"],
});
try {
  const tab = await browser.newPage();
  await tab.setViewport({ width: 1280, height: 720 });
  const found = { complaints: [], requests: [] };
  tab.on("console", (message) => found.complaints.push(message.text()));
  tab.on("pageerror", (error) => found.complaints.push(String(error.message ?? error)));
  tab.on("request", (request) => found.requests.push(request.url().split(":")[0]));
  await tab.goto(page);

  const status = () => tab.$eval("[role=status]", (element) => element.textContent);
  const until = async (wanted) => {
    const end = Date.now() + 60_000;
    while (!wanted.test(await status())) {
      if (Date.now() > end) throw new Error(`the page says: ${await status()}`);
      await new Promise((done) => setTimeout(done, 50));
    }
    return status();
  };
  const press = async (name) => {
    const path = `xpath///button[normalize-space()="${name}" and not(@disabled)]`;
    await (await tab.waitForSelector(path)).click();
  };
  /** What `Save as JSON` saves. */
  const saved = async () => {
    await tab.evaluate(() => {
      const make = URL.createObjectURL;
      URL.createObjectURL = (blob) => {
        URL.createObjectURL = make;
        globalThis.saved = blob.text();
        return make.call(URL, blob);
      };
    });
    await press("Save as JSON");
    await tab.waitForFunction(() => "saved" in globalThis);
    const text = await tab.evaluate(() => globalThis.saved);
    await tab.evaluate(() => void delete globalThis.saved);
    return JSON.parse(text);
  };

  found.title = await tab.title();
  found.heading = await tab.$eval("h1", (element) => element.textContent);
  found.end = await until(/End of the clip/);
  found.whole = await saved();

  await press("Step back");
  await tab.waitForFunction(() => document.querySelector(".player-where")?.textContent?.startsWith("Next"));
  found.where = await tab.$eval(".player-where", (element) => element.textContent);
  await press("Reset");
  await press("Next frame");
  await press("Next frame");
  await press("Run");
  await until(/End of the clip/);
  found.again = await saved();

  const input = await tab.$("input[type=file]");
  await input.uploadFile(clip);
  await until(/Press Run/);
  await press("Run");
  await until(/End of the clip/);
  found.own = await saved();

  await tab.select("select", "camera");
  found.refused = await until(/^camera: /);
  await press("Run");
  await until(/End of the clip/);
  found.kept = await saved();
  // Both themes, wide and on a phone.
  const axe = readFileSync(axeFile, "utf8");
  found.violations = [];
  for (const scheme of ["light", "dark"]) {
    for (const width of [1280, 360]) {
      await tab.setViewport({ width, height: 720 });
      await tab.evaluate((name) => document.documentElement.setAttribute("data-theme", name), scheme);
      const seen = await tab.evaluate(`${axe}; axe.run().then((all) => all.violations.map(
        (each) => each.id + ": " + each.nodes.map((node) => node.html).join(" ")))`);
      const over = await tab.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      if (over > 0) seen.push(`wider than its window by ${over}`);
      found.violations.push(...seen.map((text) => `${scheme} ${width}: ${text}`));
    }
  }
  console.log(JSON.stringify(found));
} finally {
  await browser.close();
}
