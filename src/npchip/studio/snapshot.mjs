// Write Pyodide's memory with npchip's compiler loaded and warm, for a quick start of the page.
// node snapshot.mjs PYODIDE_FOLDER NPCHIP_ZIP OUTPUT

import { readFileSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [pyodideFolder, archive, output] = process.argv.slice(2).map((path) => resolve(path));

// A snapshot does not hold the files, so all modules and tables are loaded now.
const LOAD_ALL = `
import gc, importlib, pathlib, sys

sys.path.insert(0, "/npchip")
for path in sorted(pathlib.Path("/npchip").rglob("*.py")):
    name = ".".join(path.relative_to("/npchip").with_suffix("").parts).removesuffix(".__init__")
    try:
        importlib.import_module(name)
    except ModuleNotFoundError as error:
        if not (error.name or "").startswith("numpy"):
            raise
from npchip.studio.toolchain import page

page.warm()
# All of this stays: the collector need not look at it during an edit.
gc.collect()
gc.freeze()
del gc, importlib, pathlib, sys, path, name
`;

try {
  const { loadPyodide } = await import(pathToFileURL(`${pyodideFolder}/pyodide.mjs`).href);
  const python = await loadPyodide({ indexURL: `${pyodideFolder}/`, _makeSnapshot: true });
  python.unpackArchive(new Uint8Array(readFileSync(archive)), "zip", { extractDir: "/npchip" });
  python.runPython(LOAD_ALL);
  writeFileSync(output, python.makeMemorySnapshot());
} catch (error) {
  // Not the error itself: Node would print the line at fault, and Pyodide is a single one.
  process.stderr.write(`${error.message}\n`);
  process.exitCode = 1;
}
