/** The panel: the studio's array and processor, fed by the extension. */

import { render, type JSX } from "preact";
import { provide, type Actions } from "../../../../../src/npchip/studio/page/actions";
import { ArrayView } from "../../../../../src/npchip/studio/page/array/ArrayView";
import { Processor } from "../../../../../src/npchip/studio/page/array/Processor";
import { quantityText } from "../../../../../src/npchip/studio/page/array/names";
import { chosen, message, program, running, shownCell, view } from "../../../../../src/npchip/studio/page/store";
import type { FromPanel, ToPanel } from "./messages";

declare function acquireVsCodeApi(): { postMessage(message: FromPanel): void };

const editor = acquireVsCodeApi();
/** Who waits for the answer to a condition, by its number. */
const waiting = new Map<number, (wrong: string | null) => void>();
let asked = 0;

/** Requests of the two components; `tests/editors` holds that there are no others. */
const offered: Pick<Actions, "choose" | "showCell" | "addCondition" | "whoWrote"> = {
  choose(row, column) {
    chosen.value = { row, column };
    editor.postMessage({ kind: "choose", row, column });
  },
  showCell(cell) {
    shownCell.value = cell;
  },
  addCondition(text) {
    const id = ++asked;
    editor.postMessage({ kind: "addCondition", id, text });
    return new Promise((resolve) => waiting.set(id, resolve));
  },
  whoWrote(value) {
    editor.postMessage({ kind: "whoWrote", text: quantityText(value) });
  },
};
provide(offered as Actions);

function hear(said: ToPanel): void {
  switch (said.kind) {
    case "program":
      view.value = null;
      program.value = said.program;
      running.value = false;
      break;
    case "view":
      running.value = false;
      view.value = said.view;
      break;
    case "running":
      running.value = true;
      break;
    case "said":
      message.value = said.message;
      break;
    case "answer":
      waiting.get(said.id)?.(said.wrong);
      waiting.delete(said.id);
  }
}

function Panel(): JSX.Element {
  return (
    <main>
      <p class={`panel-said panel-${message.value.kind}`} role="status" aria-label="Messages">
        {message.value.text}
      </p>
      <ArrayView />
      <Processor />
    </main>
  );
}

addEventListener("message", ({ data }: MessageEvent<ToPanel>) => hear(data));
render(<Panel />, document.body);
editor.postMessage({ kind: "ready" });
