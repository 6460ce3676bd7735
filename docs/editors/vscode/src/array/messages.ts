/** Messages between the extension and its panel. */

import type { ChipView, ProgramInfo } from "../../../../../src/npchip/studio/page/protocol";
import type { Message } from "../../../../../src/npchip/studio/page/store";

export type { ChipView, Message, ProgramInfo };

/** To the panel. */
export type ToPanel =
  | { kind: "program"; program: ProgramInfo }
  | { kind: "view"; view: ChipView }
  | { kind: "running" }
  | { kind: "said"; message: Message }
  | { kind: "answer"; id: number; wrong: string | null };

/** From the panel. */
export type FromPanel =
  | { kind: "ready" }
  | { kind: "choose"; row: number; column: number }
  | { kind: "addCondition"; id: number; text: string }
  | { kind: "whoWrote"; text: string };
