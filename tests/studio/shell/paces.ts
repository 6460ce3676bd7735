/** The pace that the chip gets, and what passes for a drawing. Prints both, as JSON. */

import { drawingIn } from "../../../src/npchip/studio/page/frames/draw";
import type { Clip, Pace } from "../../../src/npchip/studio/page/protocol";
import { asClip, paceNow } from "../../../src/npchip/studio/page/shell/pace";
import { clip, pace } from "../../../src/npchip/studio/page/store";

const film = (fps: number | null): Clip => ({ name: "film", count: 0, rows: 8, cols: 8, data: new Uint8Array(), fps });

function given(from: Clip | "live", chosen: Pace, rate: boolean): Pace {
  clip.value = from;
  pace.value = chosen;
  asClip.value = rate;
  return paceNow();
}

const frames = (rate: number): Pace => ({ unit: "frames", rate });
const stroke = { points: [{ row: 1, col: 2 }], brush: 6, grey: null };
const drawing = { rows: 8, cols: 8, background: 3, strokes: [stroke], motion: { rows: 0, cols: 0.25 }, frames: 9 };
const wrong = [null, "text", { ...drawing, strokes: [{ ...stroke, brush: 1e9 }] }, { ...drawing, motion: null }];
console.log(
  JSON.stringify({
    chosen: given(film(25), frames(15), false),
    clip: given(film(25), frames(15), true),
    unstated: given(film(null), frames(15), true),
    camera: [frames(30), frames(5), "max" as const, { unit: "steps" as const, rate: 50 }].map((each) =>
      given("live", each, true),
    ),
    drawing: drawingIn(drawing) === drawing,
    wrong: wrong.map(drawingIn),
  }),
);
