/** Looks back at earlier frames. */

import type { JSX } from "preact";
import { act } from "../actions";
import { batches, frameCount, shownFrame } from "../store";
import { firstFrame } from "./frames";
import { shown, useSlowly } from "./shown";

/** A slider over the frames that are kept, with buttons for one frame back and forth. */
export function FrameSlider(): JSX.Element {
  const { first, newest, at, follows } = useSlowly(
    () => ({
      first: firstFrame(batches.value),
      newest: frameCount.value - 1,
      at: shown.value,
      follows: shownFrame.value === null,
    }),
    100,
  );
  const none = newest < 0;
  const go = (frame: number): void => act().showFrame(frame >= newest ? null : frame);
  return (
    <div class="results-slider" role="group" aria-label="Frame to show">
      <IconButton name="First frame" icon="|◀" off={none || at <= first} press={() => go(first)} />
      <IconButton
        name="Previous frame"
        icon="◀"
        off={none || at <= first}
        press={() => act().showFrame(at - 1)}
      />
      <input
        type="range"
        aria-label="Frame"
        aria-valuetext={none ? "no frame yet" : `frame ${at} of ${first} to ${newest}`}
        min={first}
        max={Math.max(first, newest)}
        value={Math.max(first, at)}
        disabled={none}
        onInput={(event) => act().showFrame(event.currentTarget.valueAsNumber)}
      />
      <IconButton
        name="Next frame"
        icon="▶"
        off={none || at >= newest}
        press={() => go(at + 1)}
      />
      <button
        type="button"
        aria-disabled={none || follows}
        onClick={() => {
          if (!none && !follows) act().showFrame(null);
        }}
      >
        Newest
      </button>
      <span class="results-slider-text">
        {none ? "no frame yet" : `frame ${at.toLocaleString("en")}`}
        {!none && !follows && <span> of {newest.toLocaleString("en")}</span>}
      </span>
    </div>
  );
}

function IconButton(props: {
  name: string;
  icon: string;
  off: boolean;
  press: () => void;
}): JSX.Element {
  return (
    <button
      type="button"
      aria-label={props.name}
      title={props.name}
      aria-disabled={props.off}
      onClick={() => !props.off && props.press()}
    >
      <span aria-hidden="true">{props.icon}</span>
    </button>
  );
}
