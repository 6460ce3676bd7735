/** Errors in frames, each with its remedy. */

/** Rows and columns of pixels. */
export interface Size {
  rows: number;
  cols: number;
}

/** Method for frames of another size: cut out the centre, or average areas. */
export type Fit = "crop" | "resize";

/** Frames that cannot be had. `code` is npchip's own, such as NP214; the message holds the help. */
export class FramesError extends Error {
  override name = "FramesError";

  constructor(
    readonly code: string,
    readonly text: string,
    readonly help: string | null = null,
  ) {
    super(help === null ? text : `${text}. ${help}`);
  }
}

/** Frames of another size without a choice how to fit them: the page has to ask. */
export class SizeError extends FramesError {
  /** True if the frames are large enough to be cropped. */
  readonly croppable: boolean;

  constructor(
    name: string,
    readonly found: Size,
    readonly wanted: Size,
    help?: string,
  ) {
    const croppable = found.rows >= wanted.rows && found.cols >= wanted.cols;
    const way = croppable ? "Crop to the centre, resize," : "Resize";
    super(
      "NP217",
      `${name}: expected frames of ${sizeText(wanted)} (rows x columns), found ${sizeText(found)}`,
      help ?? `${way} or choose a machine of that size`,
    );
    this.croppable = croppable;
  }
}

/** Greatest number of pixels of a picture, as in npchip. */
const MAX_PIXELS = 1 << 25;

/** Write a size as messages do. */
export function sizeText(size: Size): string {
  return `${size.rows} x ${size.cols}`;
}

export function damaged(name: string, reason: string, help: string | null = null): FramesError {
  return new FramesError("NP214", `${name}: damaged, or not what its name says: ${reason}`, help);
}

export function noFrames(name: string): FramesError {
  return new FramesError("NP215", `${name}: holds no frames`, "A clip needs at least one frame");
}

/** Return the error for a kind of file, or of its content, that this page does not read. */
export function notHere(name: string, what: string, help: string): FramesError {
  return new FramesError("NP212", `${name}: ${what}`, help);
}

/** Throw unless a picture of this size may be decoded. */
export function checkPixels(size: Size, name: string): void {
  if (size.rows === 0 || size.cols === 0) throw damaged(name, "it has no pixels");
  if (size.rows * size.cols > MAX_PIXELS) {
    throw new FramesError(
      "NP222",
      `${name}: a picture of ${sizeText(size)} (rows x columns) is too large: at most ${MAX_PIXELS} pixels`,
      "Scale it down first",
    );
  }
}

/** Return the error for channels of more than 8 bits. */
export function tooDeep(name: string, found: string): FramesError {
  return new FramesError(
    "NP224",
    `${name}: expected 8 bits per channel, found ${found}`,
    "Scale its values to 0-255 and save it with 8 bits, or as a uint8 .npy",
  );
}
