/** The places and conditions at which a run stops. */

import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useId } from "preact/hooks";
import { act } from "../actions";
import { heard } from "../say";
import { breakKey, breaks, conditions, disabled } from "../store";

/** Conditions that teach the language: docs/debugging.md has them all. */
const EXAMPLES: { text: string; means: string }[] = [
  { text: "np(2,3).r4 == 7", means: "r4 of the NP in row 2, column 3 becomes 7" },
  { text: "any r3 > 40", means: "r3 of some NP becomes greater than 40" },
  { text: "all Z == 1", means: "Z becomes set in all NPs" },
  { text: "np(2,3).mem[18] changes", means: "an instruction changes this byte" },
  { text: "scan if any r3 > 3", means: "before the label scan, if it holds" },
  { text: "pixel(20,33) < 10", means: "a pixel of the exposed frame becomes dark" },
  { text: "mask empty", means: "no NP is active any more" },
  { text: "frame == 7", means: "frame 7 is exposed" },
  { text: "output 2", means: "something is sent to port 2" },
];

/** Breakpoints of lines, conditions, and a field for new ones. */
export function Breaks(): JSX.Element {
  const none = !breaks.value.length && !conditions.value.length;
  return (
    <div class="array-breaks">
      {none ? (
        <p class="array-empty">Nothing stops a run. Click beside a line number, or add a condition.</p>
      ) : (
        <ul>
          {breaks.value.map(({ file, line, condition }) => (
            <LineItem key={breakKey(file, line)} file={file} line={line} condition={condition} />
          ))}
          {conditions.value.map((text) => (
            <ConditionItem key={text} text={text} />
          ))}
        </ul>
      )}
      <NewCondition />
    </div>
  );
}

function Switch({ name, text }: { name: string; text: string }): JSX.Element {
  return (
    <input
      type="checkbox"
      aria-label={`Stop at ${text}`}
      title="Stop here, or skip it for now"
      checked={!disabled.value.has(name)}
      onChange={(event) => act().enableBreak(name, event.currentTarget.checked)}
    />
  );
}

function LineItem({ file, line, condition }: { file: string; line: number; condition: string }): JSX.Element {
  const place = `${file}:${line}`;
  return (
    <li>
      <Switch name={breakKey(file, line)} text={place} />
      <button type="button" class="array-place" onClick={() => act().show(file, line)}>
        {place}
      </button>
      <Entry
        label={`Condition of ${place}`}
        placeholder="always"
        value={condition}
        take={(text) => act().setBreakCondition(file, line, text)}
      />
      <Remove text={place} remove={() => act().toggleBreak(file, line)} />
    </li>
  );
}

function ConditionItem({ text }: { text: string }): JSX.Element {
  const change = async (changed: string): Promise<string | null> => {
    if (!changed) act().removeCondition(text);
    if (!changed || changed === text) return null;
    const wrong = await act().addCondition(changed);
    if (wrong === null) act().removeCondition(text);
    return wrong;
  };
  return (
    <li>
      <Switch name={text} text={text} />
      <Entry label={`Condition ${text}`} placeholder="" value={text} take={change} />
      <Remove text={text} remove={() => act().removeCondition(text)} />
    </li>
  );
}

function Remove({ text, remove }: { text: string; remove: () => void }): JSX.Element {
  return (
    <button type="button" aria-label={`Remove ${text}`} title="Remove" onClick={remove}>
      ✕
    </button>
  );
}

interface EntryProps {
  label: string;
  placeholder: string;
  value: string;
  /** Returns why the text cannot be taken. */
  take: (text: string) => Promise<string | null>;
}

/** A field that is read when it is left or Enter is pressed; what is wrong stands beneath. */
function Entry({ label, placeholder, value, take }: EntryProps): JSX.Element {
  const id = useId();
  const wrong = useSignal<string | null>(null);
  return (
    <span class="array-entry">
      <input
        type="text"
        aria-label={label}
        placeholder={placeholder}
        autocomplete="off"
        spellcheck={false}
        value={value}
        aria-invalid={wrong.value !== null}
        aria-describedby={id}
        onChange={async (event) => {
          wrong.value = await take(event.currentTarget.value.trim());
        }}
      />
      <span id={id} class="array-wrong" role="alert">
        {wrong.value}
      </span>
    </span>
  );
}

function NewCondition(): JSX.Element {
  const id = useId();
  const text = useSignal("");
  const wrong = useSignal<string | null>(null);
  const add = async (): Promise<void> => {
    const wanted = text.value.trim();
    wrong.value = wanted ? await act().addCondition(wanted) : "Write a condition first.";
    if (wrong.value === null) text.value = "";
  };
  return (
    <form
      class="array-new"
      onSubmit={(event) => {
        event.preventDefault();
        heard(add());
      }}
    >
      <label for={`${id}-text`}>Stop when</label>
      <input
        id={`${id}-text`}
        type="text"
        placeholder="any r3 > 40"
        autocomplete="off"
        spellcheck={false}
        value={text.value}
        aria-invalid={wrong.value !== null}
        aria-describedby={`${id}-wrong`}
        onInput={(event) => {
          text.value = event.currentTarget.value;
          wrong.value = null;
        }}
      />
      <button type="submit">Add</button>
      <pre id={`${id}-wrong`} class="array-wrong" role="alert">
        {wrong.value}
      </pre>
      <details class="array-examples">
        <summary>Examples</summary>
        <ul>
          {EXAMPLES.map((example) => (
            <li key={example.text}>
              <button
                type="button"
                onClick={() => {
                  text.value = example.text;
                  wrong.value = null;
                }}
              >
                {example.text}
              </button>{" "}
              {example.means}
            </li>
          ))}
        </ul>
      </details>
    </form>
  );
}
