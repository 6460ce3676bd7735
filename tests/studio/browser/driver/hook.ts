/** What the page offers to scripts as `globalThis.npchip`. */

import type { Actions } from "../../../../src/npchip/studio/page/actions";
import type { ChipClient, Compiler } from "../../../../src/npchip/studio/page/protocol";
import type * as store from "../../../../src/npchip/studio/page/store";

export interface Hook {
  store: typeof store;
  act(): Actions;
  compiler: Compiler;
  chip: ChipClient;
}

declare global {
  var npchip: Hook | undefined;
}
