/** Kinds of files: what their names and first bytes say. */

import { standsAt } from "./bytes";
import { FramesError, notHere } from "./errors";

export const IMAGES = [
  ...[".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff"],
  ...[".gif", ".webp", ".pgm", ".ppm", ".pbm", ".pnm"],
];
export const VIDEOS = [".mp4", ".m4v", ".mov", ".avi", ".mkv", ".webm", ".mpg", ".mpeg"];

/** Types of files that a file picker offers. */
export const ACCEPT = [".npy", ...IMAGES, ...VIDEOS].join(",");

/** Return the end of a file's name from its last point, in small letters. */
export function suffixOf(name: string): string {
  return /[^/.]+(\.[^./]+)$/.exec(name)?.[1]?.toLowerCase() ?? "";
}

/** Kinds by offset and text of their signature, with names and suffixes. */
const SIGNATURES: [number, string, string, string[]][] = [
  [0, "\x93NUMPY", "an .npy array", [".npy"]],
  [0, "PK\x03\x04", "a zip or .npz archive", []],
  [0, "\x89PNG", "a PNG image", [".png"]],
  [0, "\xff\xd8\xff", "a JPEG image", [".jpg", ".jpeg"]],
  [0, "GIF8", "a GIF image", [".gif"]],
  [0, "BM", "a BMP image", [".bmp"]],
  [0, "II*\0", "a TIFF image", [".tif", ".tiff"]],
  [0, "MM\0*", "a TIFF image", [".tif", ".tiff"]],
  [8, "WEBP", "a WebP image", [".webp"]],
  [8, "AVI ", "an AVI video", [".avi"]],
  [0, "\x1aE\xdf\xa3", "a Matroska or WebM video", [".mkv", ".webm"]],
  [4, "ftyp", "an MP4 or MOV video", [".mp4", ".m4v", ".mov"]],
];

/** Return a hint if the first bytes of a file contradict its name. */
export function resemblance(start: Uint8Array, name: string): string | null {
  for (const [at, signature, kind, suffixes] of SIGNATURES) {
    if (standsAt(start, at, signature) && !suffixes.includes(suffixOf(name))) {
      return `Its content looks like ${kind}`;
    }
  }
  return null;
}

/** Return the error for a scene as `npchip scene` draws it: that needs NumPy, which the page has not. */
export function sceneFile(name: string): FramesError {
  const stem = name.replace(/\.[^.]*$/, "");
  const help = `Draw it with npchip scene ${name} -o ${stem}.npy, then open ${stem}.npy here`;
  return notHere(name, "scene files cannot be drawn in the page", help);
}

/** Return the error for a name that is no kind of frames. */
export function unknownKind(name: string): FramesError {
  const suffix = suffixOf(name);
  if (suffix === ".yaml" || suffix === ".yml") return sceneFile(name);
  if (suffix === ".npz") {
    const help = "Take one array out: np.save('clip.npy', np.load('clip.npz')['name'])";
    return notHere(name, "'.npz' is not a kind of frames", help);
  }
  const kind = suffix ? `'${suffix}' is not` : "a name without suffix does not tell";
  const help = `Expected .npy, images (${IMAGES.join(" ")}) or video (${VIDEOS.join(" ")})`;
  return notHere(name, `${kind} a kind of frames`, help);
}
