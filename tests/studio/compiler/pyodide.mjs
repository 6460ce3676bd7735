// Call the compiler of the page in Pyodide, in Node, through the page's own loader.
// node pyodide.mjs LOADER SITE < CALLS: prints an answer a line, the modules in base64.

import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [loader, site] = process.argv.slice(2);
const { startPython } = await import(loader);
const { loadPyodide } = await import(pathToFileURL(`${site}/pyodide/pyodide.mjs`).href);

console.info = console.error; // answers only on standard output
const { calls, snapshot } = JSON.parse(readFileSync(0, "utf8"));
const begin = performance.now();
const python = await startPython(
  Promise.resolve(loadPyodide),
  `${site}/pyodide/`,
  async (path) => {
    if (path.endsWith("snapshot.bin") && !snapshot) throw new Error("left out by the test");
    return new Uint8Array(readFileSync(`${site}/${path}`));
  },
  () => undefined,
);
const loaded = performance.now() - begin;
process.stderr.write(`loaded in ${Math.round(loaded)} ms\n`);
for (const { method, args, blobs } of calls) {
  const started = process.cpuUsage();
  const answer = python.call(
    method,
    JSON.stringify(args),
    (blobs ?? []).map((blob) => new Uint8Array(Buffer.from(blob, "base64"))),
  );
  const { user, system } = process.cpuUsage(started);
  const milliseconds = (user + system) / 1000;
  const module = answer.module && Buffer.from(answer.module).toString("base64");
  console.log(JSON.stringify({ text: answer.text, module, milliseconds }));
}
