/** Opening the reader's own files as a clip, with the frames that `npchip run` would take. */

import type { Clip } from "../protocol";
import { openNpy } from "./arrays";
import { damaged, type Fit, FramesError, type Size } from "./errors";
import { IMAGES, resemblance, suffixOf, unknownKind, VIDEOS } from "./kinds";
import { inOrder } from "./order";
import type { Progress } from "./take";

/**
 * Open a `.npy` file, an image with all its pictures, a video, or several images as one clip.
 *
 * Rejects with `SizeError` if the frames have another size and `fit` is null, with another
 * `FramesError` for files that cannot be used, and with the signal's reason once it is stopped.
 */
export async function openFiles(
  files: File[],
  size: Size,
  fit: Fit | null,
  onProgress: Progress,
  signal: AbortSignal,
): Promise<Clip> {
  const [file] = files;
  if (!file) throw new FramesError("NP210", "no file was chosen");
  try {
    if (files.length > 1) return await openList(files, size, fit, onProgress, signal);
    const suffix = suffixOf(file.name);
    if (suffix === ".npy") return await openNpy(file, size, fit, onProgress, signal);
    // The readers of files are fetched when needed: a page shows its own clips without them.
    if (IMAGES.includes(suffix)) {
      const { openImage } = await import("./images");
      return await openImage(file, size, fit, onProgress, signal);
    }
    if (VIDEOS.includes(suffix)) {
      const { openVideo } = await import("./video");
      return await openVideo(file, size, fit, onProgress, signal);
    }
    throw unknownKind(file.name);
  } catch (error) {
    signal.throwIfAborted();
    if (error instanceof DOMException && error.name === "NotReadableError") {
      const help = "Choose it again: it was moved, changed, or may not be read";
      throw new FramesError("NP211", `${file.name}: cannot be read`, help);
    }
    if (error instanceof FramesError && error.code === "NP214" && !error.help && files.length === 1) {
      const start = new Uint8Array(await file.slice(0, 16).arrayBuffer());
      const hint = resemblance(start, file.name);
      if (hint) throw new FramesError(error.code, error.text, hint);
    }
    if (error instanceof RangeError) throw damaged(file.name, "its parts do not fit together");
    throw error;
  }
}

async function openList(
  files: File[],
  size: Size,
  fit: Fit | null,
  onProgress: Progress,
  signal: AbortSignal,
): Promise<Clip> {
  const path = (file: File): string => file.webkitRelativePath || file.name;
  const found = files.filter(
    (file) => IMAGES.includes(suffixOf(file.name)) && !file.name.startsWith("."),
  );
  if (found.length === 0) {
    const named = files.slice(0, 3).map((file) => file.name).sort();
    const listed = `${named.join(", ")}${files.length > 3 ? ", ..." : ""}`;
    const help = `Choose one array or video, or images that end in ${IMAGES.join(" ")}`;
    throw new FramesError("NP213", `no images among the files: only ${listed}`, help);
  }
  const ordered = inOrder(found, path);
  const folder = path(ordered[0]!).split("/").slice(0, -1).join("/");
  const name = folder || `${ordered[0]!.name} and ${ordered.length - 1} more`;
  const { openImages } = await import("./images");
  return openImages(ordered, name, size, fit, onProgress, signal);
}
