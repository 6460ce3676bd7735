/** The bar at the top: which program, which clip, which machine, how fast; run, pause, reset. */

import { useEffect, useRef, useState } from "preact/hooks";
import type { JSX } from "preact";
import { act } from "../actions";
import type { Pace } from "../protocol";
import { language, machine, pace, running } from "../store";
import { changePace, repeat } from "./chip";
import {
  bundledClips,
  chooseBundled,
  chooseCamera,
  chooseFiles,
  chosenClip,
  sceneOpen,
} from "./clips";
import { openDialog } from "./dialogs";
import { examples, type Example } from "./examples";
import { chooseMachine } from "./machines";
import { asides, chosenExample } from "./own";
import { openAside, openExample } from "./project";
import { during } from "./say";
import { openSources } from "./sources";

/** Speeds from one instruction a second to as fast as it goes. */
const PACES: [string, Pace][] = [
  ["1 step a second", { unit: "steps", rate: 1 }],
  ["5 steps a second", { unit: "steps", rate: 5 }],
  ["50 steps a second", { unit: "steps", rate: 50 }],
  ["1 frame a second", { unit: "frames", rate: 1 }],
  ["5 frames a second", { unit: "frames", rate: 5 }],
  ["15 frames a second", { unit: "frames", rate: 15 }],
  ["30 frames a second", { unit: "frames", rate: 30 }],
  ["As fast as it goes", "max"],
];

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
        <FileButton text="Open" accept=".s,.asm,.inc,.txt" onFiles={(files) => void openSources(files)} />
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

function ExampleBox(): JSX.Element {
  const [all, setAll] = useState<Example[]>([]);
  useEffect(() => void during("Fetching the examples", examples).then((found) => setAll(found ?? [])), []);
  const chosen = chosenExample.value;
  return (
    <label class="shell-field shell-example" title={all.find((each) => each.name === chosen)?.summary ?? "Programs to start from"}>
      <span>Example</span>
      <select
        value={chosen}
        onChange={(event) => {
          const name = event.currentTarget.value;
          const aside = /^aside:(\d+)$/.exec(name);
          if (aside) void during("Opening your program", () => openAside(Number(aside[1])));
          else if (name) void during(`Opening ${name}`, () => openExample(name));
        }}
      >
        {chosen === "" ? <option value="">your program</option> : null}
        {asides.value.length ? (
          <optgroup label="Your programs">
            {asides.value.map(({ at, shared }, index) => (
              <option key={at} value={`aside:${index}`}>
                your {shared.project.main}, {new Date(at).toLocaleTimeString([], { timeStyle: "short" })}
              </option>
            ))}
          </optgroup>
        ) : null}
        {all.map((each) => (
          <option key={each.name} value={each.name} title={each.summary}>
            {each.name}
          </option>
        ))}
      </select>
    </label>
  );
}

function ClipBox(): JSX.Element {
  const [all, setAll] = useState<{ name: string; title: string }[]>([]);
  const input = useRef<HTMLInputElement>(null);
  const box = useRef<HTMLSelectElement>(null);
  useEffect(() => void during("Fetching the clips", bundledClips).then((found) => setAll(found ?? [])), []);
  const choose = async (value: string): Promise<void> => {
    if (value === "file") input.current?.click();
    else if (value === "camera") await chooseCamera();
    else if (value === "draw") sceneOpen.value = true;
    else await chooseBundled(value);
    if (box.current) box.current.value = chosenClip.value;
  };
  return (
    <label class="shell-field" title="What the chip sees">
      <span>Clip</span>
      <select ref={box} value={chosenClip.value} onChange={(event) => void choose(event.currentTarget.value)}>
        <option value="" disabled>
          none
        </option>
        {chosenClip.value === "own" ? <option value="own">your file</option> : null}
        {chosenClip.value === "scene" ? <option value="scene">your scene</option> : null}
        {all.map((each) => (
          <option key={each.name} value={each.name} title={each.title}>
            {each.name}
          </option>
        ))}
        <option value="file">Open a file …</option>
        <option value="draw">Draw a scene …</option>
        <option value="camera">Camera</option>
      </select>
      <input
        ref={input}
        type="file"
        multiple
        hidden
        aria-label="Clip file"
        accept=".npy,image/*,video/*,.pgm,.ppm,.pnm"
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          event.currentTarget.value = "";
          if (files.length) void chooseFiles(files);
        }}
      />
    </label>
  );
}

function MachineBox(): JSX.Element {
  const input = useRef<HTMLInputElement>(null);
  const names = (language.value?.machines ?? [{ name: "default", summary: "" }]).map((each) => each.name);
  const own = machine.value.text !== undefined;
  return (
    <label class="shell-field" title="How large the array is, and what each instruction costs">
      <span>Machine</span>
      <select
        value={own ? "own" : machine.value.name}
        onChange={(event) => {
          const value = event.currentTarget.value;
          event.currentTarget.value = own ? "own" : machine.value.name;
          if (value === "file") input.current?.click();
          else void chooseMachine({ name: value });
        }}
      >
        {names.map((name) => (
          <option key={name} value={name}>
            {name}
          </option>
        ))}
        {own ? <option value="own">{machine.value.name}</option> : null}
        <option value="file">Open a file …</option>
      </select>
      <input
        ref={input}
        type="file"
        hidden
        aria-label="Machine file"
        accept=".yaml,.yml"
        onChange={(event) => {
          const file = event.currentTarget.files?.[0];
          event.currentTarget.value = "";
          if (file) void file.text().then((text) => chooseMachine({ name: file.name, text }));
        }}
      />
    </label>
  );
}

function PaceBox(): JSX.Element {
  const now = PACES.findIndex(([, each]) => JSON.stringify(each) === JSON.stringify(pace.value));
  return (
    <>
      <label class="shell-field shell-speed" title="Speed">
        <span class="shell-hidden">Speed</span>
        <select
          value={now}
          onChange={(event) => {
            const chosen = PACES[Number(event.currentTarget.value)]?.[1];
            if (chosen) void changePace(chosen);
          }}
        >
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

function FileButton(props: {
  text: string;
  accept: string;
  onFiles: (files: File[]) => void;
}): JSX.Element {
  const input = useRef<HTMLInputElement>(null);
  return (
    <>
      <button type="button" onClick={() => input.current?.click()}>
        {props.text}
      </button>
      <input
        ref={input}
        type="file"
        multiple
        hidden
        aria-label={props.text}
        accept={props.accept}
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          event.currentTarget.value = "";
          if (files.length) props.onFiles(files);
        }}
      />
    </>
  );
}

