/** The mistakes of all files under the text; each leads to its place. */

import type { JSX } from "preact";
import type { Diagnostic, Place } from "../protocol";
import { diagnostics } from "../store";
import { plural } from "./sums";

interface Props {
  onGo(place: Place): void;
}

/** The list; nothing if there are no mistakes. */
export function Mistakes({ onGo }: Props): JSX.Element | null {
  const all = diagnostics.value;
  if (!all.length) return null;
  return (
    <ul role="list" class="editor-mistakes" aria-label="Mistakes">
      {all.map((fault, index) => (
        <li key={index}>
          <Mistake fault={fault} onGo={onGo} />
        </li>
      ))}
    </ul>
  );
}

function Mistake({ fault, onGo }: { fault: Diagnostic; onGo(place: Place): void }): JSX.Element {
  const { severity, code, message, help, place, notes } = fault;
  const kind = severity === "error" ? "✕ Error" : "▲ Warning";
  const text = (
    <>
      <span class={`editor-fault-${severity}`}>
        {kind} {code}
      </span>
      {place && (
        <span class="editor-where">
          {place.file}:{place.line}
        </span>
      )}
      <span>{message}</span>
      {help && <span class="editor-fault-help">{help}</span>}
    </>
  );
  return (
    <>
      {place ? (
        <button type="button" class="editor-mistake" onClick={() => onGo(place)}>
          {text}
        </button>
      ) : (
        <p class="editor-mistake">{text}</p>
      )}
      {notes.map((note, index) => (
        <button type="button" key={index} class="editor-mistake editor-fault-note" onClick={() => onGo(note.place)}>
          <span class="editor-where">
            {note.place.file}:{note.place.line}
          </span>
          <span>{note.message}</span>
        </button>
      ))}
    </>
  );
}

/** Return how many mistakes there are, in words. */
export function countText(all: readonly Diagnostic[]): string {
  const errors = all.filter(({ severity }) => severity === "error").length;
  const warnings = all.length - errors;
  const parts = [errors ? plural(errors, "error") : "", warnings ? plural(warnings, "warning") : ""];
  return parts.filter(Boolean).join(", ") || "No mistakes";
}
