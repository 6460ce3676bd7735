/** What the page gives to scripts as `globalThis.npchip`, as flows use it. */

import type { Actions } from "../../../../src/npchip/studio/page/actions";
import type { ChipClient, Compiler } from "../../../../src/npchip/studio/page/protocol";
import type * as store from "../../../../src/npchip/studio/page/store";

interface Hook {
  act(): Actions;
  chip(): ChipClient;
  compiler(): Compiler;
  store: typeof store;
}

declare global {
  /** Only functions that run in the page may use it. */
  var npchip: Hook;
}
