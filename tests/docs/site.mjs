// Opens the site in Chromium as a reader does, and prints what it found.

const [, , executablePath, puppeteerFile, url, ...programs] = process.argv;
const { default: puppeteer } = await import(puppeteerFile);

const browser = await puppeteer.launch({
  browser: "chrome",
  executablePath,
  headless: true,
  args: ["--no-sandbox"],
});
const atTheEnd = (page) =>
  page.waitForFunction(
    () => /End of the clip/.test(document.querySelector("[role=status]")?.textContent ?? ""),
    { timeout: 60_000 },
  );
try {
  const tab = await browser.newPage();
  await tab.setViewport({ width: 1280, height: 720 });
  const found = { complaints: [], requests: [] };
  tab.on("console", (message) => {
    if (message.type() === "error") found.complaints.push(message.text());
  });
  tab.on("pageerror", (error) => found.complaints.push(String(error.message ?? error)));
  tab.on("request", (request) => {
    if (!/^(data|blob|about):/.test(request.url())) found.requests.push(request.url());
  });

  await tab.goto(url);
  found.title = await tab.title();
  found.side = await tab.$eval(".sidebar-tree", (element) => element.textContent);

  await tab.type("input[type=search], input[name=q]", "JNONE");
  await tab.keyboard.press("Enter");
  await tab.waitForSelector("#search-results li a", { timeout: 60_000 });
  found.hits = await tab.$$eval("#search-results li a", (all) => all.map((each) => each.href));

  await tab.goto(`${url}course/01-pixel.html`);
  found.exercise = await tab.$eval("h1", (element) => element.firstChild.textContent);
  found.picture = await tab.$eval("article img", (element) => element.naturalWidth);

  await tab.goto(`${url}gallery/trajectory.html`);
  const place = await tab.waitForSelector("iframe.live");
  await place.scrollIntoView();
  const frame = await place.contentFrame();
  await atTheEnd(frame);
  found.live = await frame.$eval("h1", (element) => element.textContent);

  found.ran = [];
  for (const program of programs) {
    await tab.goto(`${url}live/${program}.html`);
    await atTheEnd(tab);
    found.ran.push(await tab.$eval("h1", (element) => element.textContent));
  }
  console.log(JSON.stringify(found));
} finally {
  await browser.close();
}
