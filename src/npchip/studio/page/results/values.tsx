/** Numbers and lists of the frame that is shown. */

import type { JSX } from "preact";
import { batches } from "../store";
import { cyclesOf, isImage, sentIn, setupOf } from "./frames";
import { columns, shown, useSlowly } from "./shown";

/** Names and values; a list takes a line of its own. */
export function Values(): JSX.Element | null {
  const values = useSlowly(read, 100);
  if (!values.length) return null;
  return (
    <dl class="results-values" aria-label="Values of the frame">
      {values.map(({ name, text, wide }) => (
        <div key={name} class={wide ? "results-wide" : ""}>
          <dt>{name}</dt>
          <dd>{text}</dd>
        </div>
      ))}
    </dl>
  );
}

function read(): { name: string; text: string; wide: boolean }[] {
  const frame = shown.value;
  const cycles = frame < 0 ? setupOf(batches.value)?.cycles : cyclesOf(batches.value, frame);
  if (cycles === undefined) return [];
  const numbers = columns.value.filter((column) => !isImage(column));
  return [
    ...numbers.map(({ name, kind }) => ({
      name,
      text: asText(sentIn(batches.value, name, frame)),
      wide: kind === "list",
    })),
    { name: "cycles", text: cycles.toLocaleString("en"), wide: false },
  ];
}

/** Return a number or list as text. */
export function asText(value: ReturnType<typeof sentIn>): string {
  if (value === null || value === undefined) return "–";
  return typeof value === "number" ? String(value) : value.length ? value.join(" ") : "(empty)";
}
