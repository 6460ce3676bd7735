/** Memory for frames, and frames as they come. */

import type { Clip } from "../protocol";
import { breathe } from "./bytes";
import { type Fit, FramesError, noFrames, type Size } from "./errors";
import { fitPicture } from "./fit";
import type { Picture } from "./luma";

/** Told how far the work is: 0 to 1, or null if that is unknown. */
export type Progress = (share: number | null) => void;

/** Most bytes of a clip; browsers end pages that take a few times as much. */
const MOST = 1 << 29;

/** Milliseconds between two pictures of a screen: a timer for each picture would take longer. */
const FRAME = 16;

/** Take memory for frames, or say that they are too many. */
export function takeMemory(size: number, name: string): Uint8Array<ArrayBuffer> {
  const help = "Cut the clip shorter, or run it outside of the page: npchip run --frames";
  const error = new FramesError("NP222", `${name}: the frames do not fit in the page's memory`, help);
  if (size > MOST) throw error;
  try {
    return new Uint8Array(size);
  } catch {
    throw error;
  }
}

/** Frames that come one by one, fitted to the sensor. */
export class Frames {
  count = 0;
  private breathed = performance.now();
  private data: Uint8Array<ArrayBuffer>;

  constructor(
    private readonly name: string,
    private readonly size: Size,
    private readonly fit: Fit | null,
    private readonly signal: AbortSignal,
    expected = 1,
  ) {
    this.data = takeMemory(Math.max(expected, 1) * size.rows * size.cols, name);
  }

  /** Add a picture; `where` names it in messages. */
  add(picture: Picture, where: string): void {
    const pixels = this.size.rows * this.size.cols;
    const { data } = fitPicture(picture, this.size, this.fit, where);
    const end = (this.count + 1) * pixels;
    if (end > this.data.length) {
      const larger = takeMemory(Math.max(end, Math.min(2 * this.data.length, MOST)), this.name);
      larger.set(this.data);
      this.data = larger;
    }
    this.data.set(data, this.count * pixels);
    this.count++;
  }

  /** Let the browser draw now and then, and throw if the reader has stopped the work. */
  async breathe(): Promise<void> {
    this.signal.throwIfAborted();
    if (performance.now() - this.breathed < FRAME) return;
    await breathe(this.signal);
    this.breathed = performance.now();
  }

  clip(fps: number | null): Clip {
    if (this.count === 0) throw noFrames(this.name);
    const { rows, cols } = this.size;
    const data = this.data.slice(0, this.count * rows * cols);
    return { name: this.name, count: this.count, rows, cols, data, fps };
  }
}
