/** The clips that come with the page. */

import type { Clip } from "../protocol";
import { openNpy } from "./arrays";
import { type Fit, FramesError, type Size } from "./errors";

/** A clip of `clips/index.json`, which the build writes. */
export interface BundledClip extends Size {
  name: string;
  title: string;
  count: number;
  fps: number | null;
}

let listed: Promise<BundledClip[]> | null = null;

/** List the clips that come with the page. */
export function bundledClips(): Promise<BundledClip[]> {
  listed ??= fetched("clips/index.json", "the list of clips")
    .then((response) => response.json() as Promise<BundledClip[]>)
    .catch((error: unknown) => {
      listed = null; // the next call tries again
      throw error;
    });
  return listed;
}

/** Load a clip that comes with the page. One of another size is fitted as files are. */
export async function loadBundled(
  name: string,
  size: Size,
  fit: Fit | null,
  signal: AbortSignal = new AbortController().signal,
): Promise<Clip> {
  const entry = (await bundledClips()).find((clip) => clip.name === name);
  if (!entry) throw new FramesError("NP210", `${name}: no clip of this name comes with the page`);
  const response = await fetched(`clips/${encodeURIComponent(name)}.npy`, `the clip ${name}`, signal);
  const bytes = new Uint8Array(await response.arrayBuffer());
  addUp(bytes, entry);
  const file = new File([bytes], `${name}.npy`);
  const clip = await openNpy(file, size, fit, () => undefined, signal);
  return { ...clip, name, fps: entry.fps };
}

/** Make frames of what each adds to the one before, as the build writes them. */
function addUp(bytes: Uint8Array, { rows, cols, count }: BundledClip): void {
  const size = rows * cols;
  const second = bytes.length - (count - 1) * size;
  for (let at = second; at < bytes.length; at++) {
    bytes[at] = (bytes[at] as number) + (bytes[at - size] as number); // modulo 256
  }
}

async function fetched(path: string, what: string, signal?: AbortSignal): Promise<Response> {
  const help = "Start npchip studio again, or reload the page";
  let response: Response;
  try {
    response = await fetch(new URL(path, document.baseURI), signal ? { signal } : {});
  } catch {
    signal?.throwIfAborted();
    throw new FramesError("NP211", `${what} cannot be loaded`, help);
  }
  if (!response.ok) throw new FramesError("NP211", `${what} cannot be loaded: ${response.status}`, help);
  return response;
}
