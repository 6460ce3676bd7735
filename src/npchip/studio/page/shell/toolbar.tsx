/** The bar at the top: which program, which clip, which machine, how fast; run, pause, reset. */

import type { JSX } from "preact";
import { act } from "../actions";
import { heard } from "../say";
import { pace, running } from "../store";
import { PACES, paceIndex } from "../control/paces";
import { ClipBox, ExampleBox, FileButton, MachineBox } from "./boxes";
import { changePace, repeat } from "./chip";
import { openDialog } from "./dialogs";
import { openAny } from "./open";
import { asClip, clipRate } from "./pace";

export function Toolbar(): JSX.Element {
  return (
    <header class="shell-bar">
      <strong class="shell-name">npchip</strong>
      <ExampleBox />
      <ClipBox />
      <MachineBox />
      <div role="group" aria-label="Run" class="shell-group">
        {/* Neither is ever disabled: that would take the keyboard's focus from whoever pressed it. */}
        <button
          type="button"
          class={running.value ? "shell-idle" : "shell-primary"}
          title="Run the program on the clip (F5)"
          onClick={() => act().run()}
        >
          Run
        </button>
        <button
          type="button"
          class={running.value ? "shell-primary" : "shell-idle"}
          title="Stop where it is; Run goes on from there (F6)"
          onClick={() => act().pause()}
        >
          Pause
        </button>
        <button type="button" title="Back to the first instruction and frame" onClick={() => act().reset()}>
          Reset
        </button>
      </div>
      <PaceBox />
      <div role="group" aria-label="Program file" class="shell-group shell-file">
        <FileButton
          text="Open"
          box="Open"
          title="Open a program with what it includes, or a machine file"
          accept=".s,.asm,.inc,.txt,.yaml,.yml"
          onFiles={(files) => heard(openAny(files))}
        />
        <button type="button" onClick={() => openDialog("save")}>
          Save
        </button>
        <button type="button" onClick={() => openDialog("share")}>
          Share
        </button>
        <button type="button" id="help" onClick={() => openDialog("help")}>
          Help
        </button>
      </div>
    </header>
  );
}

function PaceBox(): JSX.Element {
  const rate = clipRate();
  const now = paceIndex(PACES, pace.value);
  return (
    <>
      <label class="shell-field shell-speed" title="Speed">
        <span class="shell-hidden">Speed</span>
        <select
          value={asClip.value && rate !== null ? "clip" : now}
          onChange={(event) => {
            const { value } = event.currentTarget;
            asClip.value = value === "clip";
            heard(changePace(PACES[Number(value)]?.[1] ?? pace.peek()));
          }}
        >
          {rate === null ? null : <option value="clip">As the clip: {rate} frames a second</option>}
          {PACES.map(([name], index) => (
            <option key={name} value={index}>
              {name}
            </option>
          ))}
        </select>
      </label>
      <label class="shell-check" title="At its end the clip starts again, after a reset">
        <input
          type="checkbox"
          checked={repeat.value}
          onChange={(event) => {
            repeat.value = event.currentTarget.checked;
          }}
        />
        Repeat
      </label>
    </>
  );
}
