/** Help for a newcomer: the chip in a minute, a first task, keys, licences, the theme. */

import { signal } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";
import { Fragment, type JSX } from "preact";
import { shortcuts } from "../array/shortcuts";
import { during } from "../control/jobs";
import { heard } from "../say";
import { type Example, examples } from "./examples";
import { greeted, isNew, keptTheme, useTheme, type Theme } from "./keep";

const theme = signal<Theme>(keptTheme());
/** True once the reader has opened the help. */
export const isGreeted = signal(!isNew());

const EDITOR_KEYS: [string, string][] = [
  ["Ctrl Space", "complete a word"],
  ["F1", "explain the word at the cursor"],
  ["F8", "next mistake"],
  ["F9", "breakpoint on this line"],
  ["F12", "go to where the name is defined"],
  ["Ctrl /", "comment or uncomment lines"],
  ["Ctrl Z, Ctrl Y", "undo, redo"],
  ["Escape, then Tab", "leave the editor"],
];

export function Help(): JSX.Element {
  useEffect(() => {
    isGreeted.value = true;
    greeted();
  }, []);
  return (
    <div class="shell-help">
      <p>
        The chip has 8 × 10 small processors (<abbr title="neighborhood processors">NPs</abbr>). Each owns 8 × 8
        pixels and can add, subtract, combine bits, shift, and read its four neighbours. All execute the same
        program of at most 512 words; a mask says which of them take part.
      </p>
      <h3>A first task: show where something moves</h3>
      <ol>
        <li>
          Choose the example <b>frame_difference</b>. It runs at once: bright pixels are those that changed.
        </li>
        <li>
          Choose the clip <b>mouse_run</b> and press <b>Run</b>, or choose <b>Camera</b> and wave. A clip of 30 frames
          takes a second: tick <b>Repeat</b> to see it again and again, or go back with the slider under the picture.
        </li>
        <li>
          With <b>Repeat</b> ticked, choose <b>trajectory</b>. It finds the middle of what moves and predicts the next
          place. In its line 38 change <code>.equ THRESHOLD, 32</code> to 16 while it runs: the chip follows at once.
        </li>
        <li>
          Press <b>Step</b>: the line that runs next is marked, and the panel <b>Array</b> shows any register of all NPs.
          <b> Step back</b> undoes a step. Point at a word of the program to read what it does.
        </li>
      </ol>
      <Examples />
      <h3>Keys</h3>
      <KeyTable rows={[["F5", "run"], ["F6", "pause, while it runs"], ...travelKeys(), ...EDITOR_KEYS]} />
      <h3>Theme</h3>
      <div role="radiogroup" aria-label="Theme" class="shell-group">
        {(["system", "light", "dark"] as const).map((name) => (
          <label key={name}>
            <input
              type="radio"
              name="theme"
              checked={theme.value === name}
              onChange={() => {
                theme.value = name;
                useTheme(name);
              }}
            />{" "}
            {name}
          </label>
        ))}
      </div>
      <h3>About</h3>
      <p>
        npchip is an instruction-level emulator. Cycle counts follow a stated machine file: they are a decision, not
        the silicon's timing. Nothing that you write, open or film leaves this browser.
      </p>
      <Licences />
    </div>
  );
}

/** A summary of each example: their names in the box do not tell enough. */
function Examples(): JSX.Element {
  const [all, setAll] = useState<Example[]>([]);
  useEffect(() => {
    heard(examples().then(setAll));
  }, []);
  return (
    <details>
      <summary>What the examples do ({all.length})</summary>
      <dl>
        {all.map(({ name, summary }) => (
          <Fragment key={name}>
            <dt>
              <code>{name}</code>
            </dt>
            <dd>{summary}</dd>
          </Fragment>
        ))}
      </dl>
    </details>
  );
}

function travelKeys(): [string, string][] {
  return shortcuts.map((way) => [way.key ? `${way.key} or ${way.letter}` : way.letter, way.does]);
}

function KeyTable({ rows }: { rows: readonly (readonly [string, string])[] }): JSX.Element {
  return (
    <table class="shell-keys">
      <thead>
        <tr>
          <th scope="col">Key</th>
          <th scope="col">Does</th>
        </tr>
      </thead>
      <tbody>
        {rows.map(([key, does]) => (
          <tr key={key}>
            <td>
              <kbd>{key}</kbd>
            </td>
            <td>{does}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

interface Licence {
  name: string;
  version: string;
  licence: string;
  text: string;
}

function Licences(): JSX.Element {
  const [all, setAll] = useState<Licence[]>([]);
  useEffect(() => {
    const fetched = during("Fetching the licences", async () => (await fetch("licences.json")).json() as Promise<Licence[]>);
    heard(fetched.then((found) => setAll(found ?? [])));
  }, []);
  return (
    <details>
      <summary>Licences of what is in this page ({all.length})</summary>
      {all.map((each) => (
        <details key={each.name}>
          <summary>
            {each.name} {each.version}: {each.licence}
          </summary>
          <pre>{each.text}</pre>
        </details>
      ))}
    </details>
  );
}
