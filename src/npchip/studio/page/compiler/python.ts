/** npchip's compiler in Pyodide: from a snapshot of its memory, or from its files. */

import type { PyodideAPI, loadPyodide } from "pyodide";
import type { PyCallable, PyProxy } from "pyodide/ffi";
import type { Loading } from "./messages";

type LoadPyodide = typeof loadPyodide;
/** Fetches a file of the site; `onShare` hears how far it is, or null if that is not known. */
export type Fetch = (
  path: string,
  onShare: (share: number | null) => void,
) => Promise<Uint8Array<ArrayBuffer>>;

const SNAPSHOT = "python/snapshot.bin";
const ARCHIVE = "python/npchip.zip";
const MODULE = "npchip.studio.toolchain.page";
const STARTING = "Starting Python";

/** The compiler; `call` takes and returns JSON, and the module beside it. */
export interface Python {
  call(
    method: string,
    args: string,
    blobs: Uint8Array[],
  ): { text: string; module: Uint8Array<ArrayBuffer> | null };
  /** Use what an edit uses, so that the first one is quick. */
  warm(): void;
}

/**
 * Load the compiler. A snapshot that is missing or does not fit costs time, nothing else.
 * `indexURL` is the folder of Pyodide.
 */
export async function startPython(
  load: Promise<LoadPyodide>,
  indexURL: string,
  fetchFile: Fetch,
  onLoading: (loading: Loading) => void,
): Promise<Python> {
  const page = await fromSnapshot(load, indexURL, fetchFile, onLoading).catch((error: unknown) => {
    console.info("npchip: no snapshot, loading from files:", String(error));
    return fromFiles(load, indexURL, fetchFile, onLoading);
  });
  performance.mark("npchip:python-ready");
  const call = page.call as unknown as PyCallable;
  const warm = page.warm as unknown as PyCallable;
  return {
    warm: () => warm(),
    call(method, args, blobs) {
      const answer = call(method, args, blobs) as PyProxy;
      try {
        const [text, module] = answer.toJs() as [string, Uint8Array<ArrayBuffer> | undefined];
        return { text, module: module ?? null };
      } finally {
        answer.destroy();
      }
    },
  };
}

async function fromSnapshot(
  load: Promise<LoadPyodide>,
  indexURL: string,
  fetchFile: Fetch,
  onLoading: (loading: Loading) => void,
): Promise<Record<string, unknown>> {
  // It is on its way before Pyodide is, which waits for it when its own files are there.
  const snapshot = fetchFile(SNAPSHOT, (share) =>
    onLoading({ text: "Loading the compiler", share }),
  )
    .then(unpacked)
    .finally(() => performance.mark("npchip:snapshot-unpacked"));
  snapshot.catch(() => undefined); // Pyodide hears of it, unless it fails before
  return imported(await (await load)({ indexURL, _loadSnapshot: snapshot }));
}

async function fromFiles(
  load: Promise<LoadPyodide>,
  indexURL: string,
  fetchFile: Fetch,
  onLoading: (loading: Loading) => void,
): Promise<Record<string, unknown>> {
  onLoading({ text: STARTING, share: null });
  const [pyodide, archive] = await Promise.all([
    load.then((start) => start({ indexURL })),
    fetchFile(ARCHIVE, () => undefined),
  ]);
  onLoading({ text: "Loading the compiler", share: null });
  pyodide.unpackArchive(archive, "zip", { extractDir: "/npchip" });
  pyodide.runPython("import sys; sys.path.insert(0, '/npchip')");
  return imported(pyodide);
}

function imported(pyodide: PyodideAPI): Record<string, unknown> {
  return pyodide.pyimport(MODULE) as Record<string, unknown>;
}

/** Undo gzip, if the web server has not done so already. */
async function unpacked(data: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  if (data[0] !== 0x1f || data[1] !== 0x8b) return data;
  const stream = new Blob([data]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
