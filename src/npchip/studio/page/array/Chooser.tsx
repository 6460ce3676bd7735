/** Chooses what the array shows, and how its numbers are written. */

import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { act } from "../actions";
import type { Cell } from "../protocol";
import { program, shownCell } from "../store";
import { parseNumber, type Base } from "./format";
import { registerText } from "./names";
import { base, picture } from "./state";

const BASES: { name: Base; text: string }[] = [
  { name: "decimal", text: "decimal" },
  { name: "hex", text: "hex" },
  { name: "signed", text: "signed" },
];

/** The controls above the array. */
export function Chooser(): JSX.Element {
  const bytes = program.value?.machine.memory_bytes ?? 256;
  const banks = Array.from({ length: Math.floor(bytes / 64) }, (_, bank) => bank * 64);
  return (
    <div class="array-chooser">
      <label>
        Show{" "}
        <select value={chosenValue()} onChange={(event) => choose(event.currentTarget.value)}>
          <optgroup label="Registers">
            {Array.from({ length: 16 }, (_, number) => (
              <option key={number} value={`register:${number}`}>
                {registerText(program.value, number)}
              </option>
            ))}
          </optgroup>
          <optgroup label="Flags">
            <option value="flag:Z">Z (zero)</option>
            <option value="flag:C">C (carry, borrow)</option>
            <option value="active:">active</option>
          </optgroup>
          <optgroup label="Pictures">
            <option value="frame:">exposed frame</option>
            {banks.map((first) => (
              <option key={first} value={`bank:${first}`}>
                memory bank {first} to {first + 63}
              </option>
            ))}
          </optgroup>
          <optgroup label="Memory">
            <option value="memory:">one byte of memory</option>
          </optgroup>
        </select>
      </label>
      {!picture.value && shownCell.value.kind === "memory" && <Address bytes={bytes} />}
      <fieldset class="array-bases">
        <legend class="array-hidden">Numbers</legend>
        {BASES.map(({ name, text }) => (
          <label key={name}>
            <input
              type="radio"
              name="array-base"
              checked={base.value === name}
              onChange={() => {
                base.value = name;
              }}
            />
            {text}
          </label>
        ))}
      </fieldset>
    </div>
  );
}

function chosenValue(): string {
  const other = picture.value;
  if (other) return other.kind === "frame" ? "frame:" : `bank:${other.first}`;
  const { kind, index } = shownCell.value;
  return kind === "memory" || kind === "active" ? `${kind}:` : `${kind}:${index}`;
}

function choose(value: string): void {
  const [kind = "", index = ""] = value.split(":");
  if (kind === "frame") picture.value = { kind };
  else if (kind === "bank") picture.value = { kind, first: Number(index) };
  else show({ kind: kind as Cell["kind"], index: kind === "register" || kind === "memory" ? Number(index) : index });
}

/** Let the array show a cell. */
export function show(cell: Cell): void {
  picture.value = null;
  act().showCell(cell);
}

function Address({ bytes }: { bytes: number }): JSX.Element {
  const wrong = useSignal<string | null>(null);
  const names = Object.entries(program.value?.symbols ?? {}).filter(([, at]) => at >= 0 && at < bytes);
  const read = (text: string): void => {
    const at = parseNumber(text) ?? names.find(([name]) => name === text.trim())?.[1] ?? null;
    const fits = at !== null && at < bytes;
    wrong.value = fits ? null : `Give an address from 0 to ${bytes - 1}, or the name of a constant.`;
    if (fits) show({ kind: "memory", index: at });
  };
  return (
    <span class="array-address">
      <label>
        at address{" "}
        <input
          type="text"
          size={8}
          list="array-addresses"
          autocomplete="off"
          spellcheck={false}
          value={String(shownCell.value.index)}
          aria-invalid={wrong.value !== null}
          aria-describedby="array-address-wrong"
          onChange={(event) => read(event.currentTarget.value)}
        />
      </label>
      <datalist id="array-addresses">
        {names.map(([name, at]) => (
          <option key={name} value={name}>
            {at}
          </option>
        ))}
      </datalist>
      <span id="array-address-wrong" class="array-wrong" role="alert">
        {wrong.value}
      </span>
    </span>
  );
}
