/** A file as mediabunny reads it, without a way to read for ever. */

import { CustomSource } from "mediabunny";
import { damaged } from "./errors";

/** Bytes that are read at once. */
const WINDOW = 1 << 20;
/** Reads of one place in a row; whole files have a few. */
const MOST = 200;

/**
 * Return a file that gives up when one place is read again and again: mediabunny 1.61 does so where
 * it looks for the next part of a damaged WebM and comes within 8 bytes of its end. It keeps nothing
 * of what it reads here, or it would not ask.
 */
export function sourceOf(file: File): CustomSource {
  let window = { start: 0, data: new Uint8Array(0) };
  let [place, times] = [-1, 0];
  return new CustomSource({
    getSize: () => file.size,
    maxCacheSize: 0,
    handleUnhandledError: () => undefined,
    read: async (start, end) => {
      times = start === place ? times + 1 : 0;
      place = start;
      if (times > MOST) throw damaged(file.name, "its parts do not fit together");
      let held = window;
      if (start < held.start || end > held.start + held.data.length) {
        const blob = file.slice(start, Math.max(end, start + WINDOW));
        held = { start, data: new Uint8Array(await blob.arrayBuffer()) };
        window = held;
      }
      return held.data.subarray(start - held.start, end - held.start);
    },
  });
}
