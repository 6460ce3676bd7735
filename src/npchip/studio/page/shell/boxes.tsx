/** The boxes of the toolbar: which program, what the chip sees, which machine. */

import { useEffect, useRef, useState } from "preact/hooks";
import type { JSX } from "preact";
import { language, machine } from "../store";
import { cameras } from "../control/camera";
import { during } from "../control/jobs";
import { heard, putAway } from "../say";
import { Choice } from "./choice";
import { boxValue, bundledClips, chooseBundled, chooseCamera, chooseFiles, chosenClip, sceneOpen } from "./clips";
import { examples, type Example } from "./examples";
import { chooseMachine } from "./machines";
import { asides, chosenExample } from "./own";
import { openAside, openExample } from "./project";

export function ExampleBox(): JSX.Element {
  const [all, setAll] = useState<Example[]>([]);
  useEffect(() => heard(during("Fetching the examples", examples).then((found) => setAll(found ?? []))), []);
  const chosen = chosenExample.value;
  const choose = async (name: string): Promise<void> => {
    const aside = /^aside:(\d+)$/.exec(name);
    if (aside) await during("Opening your program", () => openAside(Number(aside[1])));
    else if (name) await during(`Opening ${name}`, () => openExample(name));
  };
  return (
    <label class="shell-field shell-example" title={all.find((each) => each.name === chosen)?.summary ?? "Programs to start from"}>
      <span>Example</span>
      <Choice value={chosen} onChoose={choose}>
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
        {all.filter((each) => !each.lesson).map(exampleOption)}
        <optgroup label="Lessons">{all.filter((each) => each.lesson).map(exampleOption)}</optgroup>
      </Choice>
    </label>
  );
}

function exampleOption({ name, summary, lesson }: Example): JSX.Element {
  return (
    <option key={name} value={name} title={summary}>
      {lesson ? `${name}: ${summary}` : name}
    </option>
  );
}

export function ClipBox(): JSX.Element {
  const [all, setAll] = useState<{ name: string; title: string }[]>([]);
  useEffect(() => heard(during("Fetching the clips", bundledClips).then((found) => setAll(found ?? []))), []);
  const choose = async (value: string): Promise<void> => {
    if (value === "camera") await chooseCamera();
    else if (value.startsWith("camera:")) await chooseCamera(value.slice("camera:".length));
    else await chooseBundled(value);
  };
  return (
    <div role="group" aria-label="What the chip sees" class="shell-clip">
      <label class="shell-field" title="What the chip sees">
        <span>Clip</span>
        <Choice value={boxValue.value} onChoose={choose}>
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
          <option value="camera">Camera</option>
          {cameras.value.map(({ deviceId, label }) => (
            <option key={deviceId} value={`camera:${deviceId}`}>
              Camera: {label}
            </option>
          ))}
        </Choice>
      </label>
      <FileButton
        text="Open clip"
        box="Clip file"
        title="Open a video, images or a .npy file"
        accept=".npy,image/*,video/*,.pgm,.ppm,.pnm"
        onFiles={(files) => heard(chooseFiles(files))}
      />
      <button
        type="button"
        title="Draw a scene that moves"
        onClick={() => {
          sceneOpen.value = true;
        }}
      >
        Draw
      </button>
    </div>
  );
}

export function MachineBox(): JSX.Element {
  const names = (language.value?.machines ?? [{ name: "default", summary: "" }]).map((each) => each.name);
  const own = machine.value.text !== undefined;
  return (
    <label class="shell-field" title="How large the array is, and what each instruction costs. Open takes a machine file, too">
      <span>Machine</span>
      <Choice value={own ? "own" : machine.value.name} onChoose={(name) => chooseMachine({ name })}>
        {names.map((name) => (
          <option key={name} value={name}>
            {name}
          </option>
        ))}
        {own ? <option value="own">{machine.value.name}</option> : null}
      </Choice>
    </label>
  );
}

/** A button that lets the reader choose files. */
export function FileButton(props: {
  text: string;
  /** Name of the box for files behind it. */
  box: string;
  title: string;
  accept: string;
  onFiles: (files: File[]) => void;
}): JSX.Element {
  const input = useRef<HTMLInputElement>(null);
  return (
    <>
      <button type="button" title={props.title} onClick={() => input.current?.click()}>
        {props.text}
      </button>
      <input
        ref={input}
        type="file"
        multiple
        hidden
        aria-label={props.box}
        accept={props.accept}
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          event.currentTarget.value = "";
          if (!files.length) return;
          putAway();
          props.onFiles(files);
        }}
      />
    </>
  );
}
