/** The files as tabs, and what can be done with a file. */

import { batch } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { act } from "../actions";
import { breakKey, breaks, diagnostics, disabled, library, openFile, project } from "../store";
import { freshName, nameFault, renamed, tabNames, without } from "./files";
import { mistakesIn, plural } from "./sums";
import { fileChange, fileChanged, forgetFileChange } from "./undo";

/** Id of the panel that tabs show. */
export const PANEL = "editor-panel";

interface Props {
  /** The file has another name from now on. */
  onRenamed(from: string, to: string): void;
}

/** Tabs of the program and its includes. */
export function Tabs({ onRenamed }: Props): JSX.Element {
  const [more, setMore] = useState(false);
  const [naming, setNaming] = useState<"new" | "rename" | null>(null);
  const list = useRef<HTMLDivElement>(null);
  const open = openFile.value;
  const { main, files } = project.value;
  const names = tabNames(project.value, open);
  const own = open in files;
  const change = fileChange.value;

  useEffect(() => {
    list.current?.querySelector('[aria-selected="true"]')?.scrollIntoView({ block: "nearest", inline: "nearest" });
  }, [open]);

  const focusTab = (name: string): void => {
    act().show(name);
    // The tab of the file takes the focus once it is drawn.
    requestAnimationFrame(() => list.current?.querySelector<HTMLElement>('[aria-selected="true"]')?.focus());
  };
  const remove = (): void => {
    if (!own || open === main) return;
    removeFile(open);
    focusTab(main);
  };
  const named = (name: string): void => {
    if (naming === "new") newFile(name);
    else if (name !== open) {
      rename(open, name, onRenamed);
      fileChanged(`Renamed ${open} to ${name}.`, () => {
        const now = project.peek().files;
        if (name in now && !(open in now)) rename(name, open, onRenamed);
      });
    }
    setNaming(null);
    focusTab(name);
  };
  const onKeyDown = (event: KeyboardEvent): void => {
    const at = names.indexOf(open);
    const next = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: names.length - 1 }[event.key];
    if (next !== undefined) focusTab(names[(next + names.length) % names.length] ?? main);
    else if (event.key === "Delete") remove();
    else if (event.key === "F2" && own) setNaming("rename");
    else return;
    event.preventDefault();
  };

  return (
    <div class="editor-files">
      <div class="editor-tabrow">
        <div role="tablist" aria-label="Files" class="editor-tabs" ref={list} onKeyDown={onKeyDown}>
          {names.map((name) => (
            <Tab key={name} name={name} shown={name === open} note={noteOf(name, main, files)} />
          ))}
        </div>
        <button type="button" class="editor-more" aria-expanded={more} onClick={() => setMore(!more)}>
          File
        </button>
      </div>
      {more && !naming && (
        <div class="editor-actions" role="group" aria-label={`What to do with ${open}`}>
          <button type="button" onClick={() => setNaming("new")}>
            New file
          </button>
          <button type="button" disabled={!own} title="F2 on the tab" onClick={() => setNaming("rename")}>
            Rename
          </button>
          <button
            type="button"
            disabled={!own || open === main}
            title={open === main ? "The main file cannot be deleted" : "Delete on the tab"}
            onClick={remove}
          >
            Delete
          </button>
          <button
            type="button"
            disabled={!own || open === main}
            title="Assemble this file, with what it includes"
            onClick={() => {
              act().setProject({ main: open, files });
              fileChanged(`${open} is the main file.`, () => {
                const now = project.peek().files;
                if (main in now) act().setProject({ main, files: now });
              });
            }}
          >
            Use as main file
          </button>
        </div>
      )}
      {naming && (
        <NameForm
          title={naming === "new" ? "Name of the new file" : `New name of ${open}`}
          initial={naming === "new" ? freshName(names) : open}
          taken={names.filter((name) => naming === "new" || name !== open)}
          onName={named}
          onCancel={() => {
            setNaming(null);
            focusTab(open);
          }}
        />
      )}
      <div role="status">
        {change && (
          <p class="editor-note">
            {change.text}{" "}
            <button
              type="button"
              onClick={() => {
                forgetFileChange();
                change.undo();
                focusTab(openFile.peek());
              }}
            >
              Undo
            </button>{" "}
            <button type="button" aria-label="Close this note" onClick={forgetFileChange}>
              ×
            </button>
          </p>
        )}
      </div>
      {!own && <Foreign name={open} />}
    </div>
  );
}

function Tab({ name, shown, note }: { name: string; shown: boolean; note: string }): JSX.Element {
  const { errors, warnings } = mistakesIn(name, diagnostics.value, project.value.main);
  return (
    <button
      type="button"
      role="tab"
      aria-selected={shown}
      aria-controls={PANEL}
      tabIndex={shown ? 0 : -1}
      title={note}
      onClick={() => act().show(name)}
    >
      {name}
      {errors > 0 && (
        <span class="editor-badge">
          <span aria-hidden="true">✕ {errors}</span>
          <span class="editor-hidden">, {plural(errors, "mistake")}</span>
        </span>
      )}
      {!errors && warnings > 0 && (
        <span class="editor-badge editor-badge-warning">
          <span aria-hidden="true">▲ {warnings}</span>
          <span class="editor-hidden">, {plural(warnings, "warning")}</span>
        </span>
      )}
    </button>
  );
}

/** A note on a file that is not the project's own, with a button that makes it so. */
function Foreign({ name }: { name: string }): JSX.Element {
  const text = library.value[name];
  return (
    <p class="editor-note">
      {text === undefined ? `${name} does not exist yet.` : `${name} comes with npchip and is read-only.`}{" "}
      <button type="button" onClick={() => act().edit(name, text ?? "")}>
        {text === undefined ? "Create it" : "Edit a copy"}
      </button>
    </p>
  );
}

function noteOf(name: string, main: string, files: Readonly<Record<string, string>>): string {
  if (name === main) return "The main file of the program";
  return name in files ? "A file of the program" : "Comes with npchip, read-only";
}

function removeFile(name: string): void {
  const text = project.peek().files[name] ?? "";
  act().show(project.peek().main);
  act().setProject(without(project.peek(), name));
  fileChanged(`Deleted ${name}.`, () => {
    act().setProject({ ...project.peek(), files: { ...project.peek().files, [name]: text } });
    act().show(name);
  });
}

function newFile(name: string): void {
  const { main, files } = project.peek();
  act().setProject({ main, files: { ...files, [name]: `; ${name} - \n` } });
  // Text written meanwhile is not lost: this offers to undo the step back in turn.
  fileChanged(`Made ${name}.`, () => removeFile(name));
}

/** Rename a file with its breakpoints; `.include` lines that name it follow. */
function rename(from: string, to: string, told: Props["onRenamed"]): void {
  batch(() => {
    told(from, to);
    for (const { file, line } of breaks.value) {
      const key = breakKey(file, line);
      if (file !== from || !disabled.value.has(key)) continue;
      act().enableBreak(key, true);
      act().enableBreak(breakKey(to, line), false);
    }
    breaks.value = breaks.value.map((each) => (each.file === from ? { ...each, file: to } : each));
    act().setProject(renamed(project.value, from, to));
    act().show(to);
  });
}

interface NameProps {
  title: string;
  initial: string;
  taken: string[];
  onName(name: string): void;
  onCancel(): void;
}

function NameForm({ title, initial, taken, onName, onCancel }: NameProps): JSX.Element {
  const [name, setName] = useState(initial);
  const [tried, setTried] = useState(false);
  const fault = nameFault(name.trim(), taken);
  return (
    <form
      class="editor-actions"
      onSubmit={(event) => {
        event.preventDefault();
        setTried(true);
        if (!fault) onName(name.trim());
      }}
      onKeyDown={(event) => event.key === "Escape" && onCancel()}
    >
      <label>
        {title}{" "}
        <input
          type="text"
          value={name}
          spellcheck={false}
          autocapitalize="off"
          aria-invalid={tried && fault !== ""}
          aria-describedby="editor-name-fault"
          ref={(input) => {
            if (input && document.activeElement !== input && !tried) input.focus();
          }}
          onInput={(event) => setName(event.currentTarget.value)}
        />
      </label>
      <button type="submit">OK</button>
      <button type="button" onClick={onCancel}>
        Cancel
      </button>
      <span id="editor-name-fault" role="alert" class="editor-name-fault">
        {tried ? fault : ""}
      </span>
    </form>
  );
}
