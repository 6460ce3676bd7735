// Opens an exported page in Chromium with a film as its camera, and prints what the program answers.

const [, , executablePath, puppeteerFile, page, film] = process.argv;
const { default: puppeteer } = await import(puppeteerFile);

const camera = ["--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream"];
const browser = await puppeteer.launch({
  browser: "chrome",
  executablePath,
  headless: true,
  args: ["--no-sandbox", ...camera, `--use-file-for-fake-video-capture=${film}`],
});
try {
  const tab = await browser.newPage();
  const complaints = [];
  tab.on("pageerror", (error) => complaints.push(String(error.message ?? error)));
  await tab.goto(page);
  await tab.waitForSelector("select:enabled");
  await tab.select("select", "camera");
  await tab.waitForFunction(() => document.querySelectorAll("tr").length > 3, { timeout: 60_000 });
  const answers = new Set();
  for (const end = Date.now() + 12_000; Date.now() < end; ) {
    const cells = await tab.$$eval("tr", (rows) => rows.map((row) => row.children[1]?.textContent));
    for (const text of cells) if (/^\d+$/.test(text ?? "")) answers.add(Number(text));
    await new Promise((done) => setTimeout(done, 100));
  }
  /** Pixels of the canvas that have the colour of the guide: their bounds, in shares of it. */
  const guide = await tab.$eval("canvas[role=img]", (canvas) => {
    const { width, height } = canvas;
    const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
    const found = { left: 1, top: 1, right: 0, bottom: 0 };
    for (let at = 0; at < data.length; at += 4) {
      if (data[at] > 90 || data[at + 1] < 180 || data[at + 2] < 230) continue;
      const [x, y] = [((at / 4) % width) / width, Math.floor(at / 4 / width) / height];
      found.left = Math.min(found.left, x);
      found.right = Math.max(found.right, x);
      found.top = Math.min(found.top, y);
      found.bottom = Math.max(found.bottom, y);
    }
    return found;
  });
  console.log(JSON.stringify({ answers: [...answers].sort((a, b) => a - b), guide, complaints }));
} finally {
  await browser.close();
}
