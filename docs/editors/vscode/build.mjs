/** Puts the extension together in `build/`, and packs it: `npm run package -- npchip.vsix`. */

import { cp, mkdir, readFile, readdir, rm, writeFile } from "node:fs/promises";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { createVSIX } from "@vscode/vsce";
import { build } from "esbuild";

const home = dirname(fileURLToPath(import.meta.url));
const made = join(home, "build");
const file = resolve(process.argv[2] ?? join(home, "npchip.vsix"));

const common = { absWorkingDir: home, bundle: true, minify: true, metafile: true, legalComments: "none", logLevel: "warning" };
// The page's files find no packages above them, or those of the studio: there may be one Preact only.
const alias = { preact: join(home, "node_modules/preact"), "@preact/signals": join(home, "node_modules/@preact/signals") };

/** The two scripts; returns the folders of the packages in them. */
async function scripts() {
  const editor = build({
    ...common,
    entryPoints: { extension: "src/extension.ts" },
    outdir: made,
    outExtension: { ".js": ".cjs" },
    platform: "node",
    format: "cjs",
    target: "node20",
    external: ["vscode"],
  });
  const panel = build({
    ...common,
    entryPoints: { panel: "src/array/panel.tsx", "panel-style": "src/array/panel.css" },
    entryNames: "[name]",
    outdir: made,
    format: "iife",
    target: "chrome120",
    jsx: "automatic",
    jsxImportSource: "preact",
    define: { "process.env.NODE_ENV": '"production"' },
    alias,
  });
  const inputs = (await Promise.all([editor, panel])).flatMap(({ metafile }) => Object.keys(metafile.inputs));
  const packages = inputs.map((input) => /^node_modules\/(?:@[^/]+\/)?[^/]+/.exec(input)?.[0]);
  return [...new Set(packages)].filter(Boolean).sort();
}

/** The licence of npchip, then those of the packages whose code is in the scripts. */
async function licences(packages) {
  const texts = [await readFile(join(home, "../../../LICENSE"), "utf8")];
  for (const name of packages) {
    const folder = join(home, name);
    const own = (await readdir(folder)).find((entry) => /^licen[cs]e/i.test(entry));
    if (!own) throw new Error(`${name} has no licence`);
    texts.push(`${name.slice("node_modules/".length)}\n\n${await readFile(join(folder, own), "utf8")}`);
  }
  await writeFile(join(made, "LICENSE.txt"), texts.join(`\n${"-".repeat(80)}\n\n`));
}

/** The manifest without what only the build needs. */
async function manifest() {
  const { scripts: _, devDependencies, private: __, type, ...rest } = JSON.parse(
    await readFile(join(home, "package.json"), "utf8"),
  );
  await writeFile(join(made, "package.json"), JSON.stringify(rest, null, 2));
}

await rm(made, { recursive: true, force: true });
await mkdir(made);
await licences(await scripts());
await manifest();
for (const name of ["language-configuration.json", "npchip.tmLanguage.json", "snippets.json", "README.md", "icon.png", "walkthrough"]) {
  await cp(join(home, name), join(made, name), { recursive: true });
}
await createVSIX({ cwd: made, packagePath: file, dependencies: false, allowMissingRepository: true });
