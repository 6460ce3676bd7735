/** Names for the browser's console: `npchip.act().run()`, `npchip.store.view.value`, … */

import { act } from "../actions";
import * as store from "../store";
import { chip, compiler } from "./parts";

const hook = { act, chip, compiler, store };

declare global {
  var npchip: typeof hook | undefined;
}

globalThis.npchip = hook;
