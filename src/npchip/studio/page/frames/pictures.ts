/** The pictures of one image file. */

import type { Picture } from "./luma";

/** Pictures in order, decoded one by one; reading them throws where the file is damaged. */
export interface Pictures {
  /** Number of pictures that the file says it has. */
  count: number;
  each: AsyncIterable<Picture>;
  /** Milliseconds that the first picture is shown, if the file says. */
  duration?: number | undefined;
}

/** Return the pictures of a file that holds one. */
export function single(decode: () => Promise<Picture> | Picture): Pictures {
  async function* each(): AsyncGenerator<Picture> {
    yield await decode();
  }
  return { count: 1, each: each() };
}
