/** Dialogs: fit a clip, draw a scene, save, share, help. */

import { signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import type { ComponentChildren, JSX } from "preact";
import { act } from "../actions";
import { SceneEditor } from "../frames/scene";
import { project } from "../store";
import { chooseFiles, fitQuestion, frameSize, give, sceneOpen } from "./clips";
import { damagedText } from "./keep";
import { Help } from "./help";
import { say, sayError } from "./say";
import { shareLink } from "./project";

type Named = "save" | "share" | "help";
const open = signal<Named | null>(null);

export function openDialog(name: Named): void {
  open.value = name;
}

function close(): void {
  open.value = null;
}

export function Dialogs(): JSX.Element {
  return (
    <>
      {open.value === "save" ? <Save /> : null}
      {open.value === "share" ? <Share /> : null}
      {open.value === "help" ? (
        <Dialog title="Help" wide onClose={close}>
          <Help />
        </Dialog>
      ) : null}
      {fitQuestion.value ? <FitQuestion /> : null}
      {sceneOpen.value ? <Scene /> : null}
    </>
  );
}

/** A modal dialog: Escape closes it, and the focus returns to where it was. */
export function Dialog(props: {
  title: string;
  wide?: boolean;
  onClose: () => void;
  children: ComponentChildren;
}): JSX.Element {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    const before = document.activeElement;
    dialog.current?.showModal();
    return () => {
      // The hint for newcomers goes once they have followed it: the Help button stands for it.
      if (before instanceof HTMLElement) (before.isConnected ? before : document.getElementById("help"))?.focus();
    };
  }, []);
  return (
    <dialog
      ref={dialog}
      class={props.wide ? "shell-dialog shell-wide" : "shell-dialog"}
      aria-labelledby="dialog-title"
      onClose={props.onClose}
    >
      <header>
        <h2 id="dialog-title">{props.title}</h2>
        <button type="button" onClick={() => dialog.current?.close()}>
          Close
        </button>
      </header>
      {props.children}
    </dialog>
  );
}

function FitQuestion(): JSX.Element | null {
  const question = fitQuestion.value;
  if (!question) return null;
  const { files, text, canCrop } = question;
  const cancel = (): void => {
    fitQuestion.value = null;
  };
  return (
    <Dialog title="The clip has another size" onClose={cancel}>
      <p>{text}</p>
      <div class="shell-group">
        <button type="button" class="shell-primary" onClick={() => void chooseFiles(files, "resize")}>
          Resize
        </button>
        <button type="button" disabled={!canCrop} onClick={() => void chooseFiles(files, "crop")}>
          Crop
        </button>
        <button type="button" onClick={cancel}>
          Cancel
        </button>
      </div>
      <p class="shell-note">
        Resize averages areas and may change the proportions. Crop takes the centre.
      </p>
    </Dialog>
  );
}

function Scene(): JSX.Element {
  const size = frameSize();
  const shut = (): void => {
    sceneOpen.value = false;
  };
  return (
    <Dialog title="Draw a scene" wide onClose={shut}>
      <SceneEditor
        size={size}
        onClip={(clip) => {
          shut();
          void give(clip, "scene").catch(sayError);
        }}
      />
    </Dialog>
  );
}

function Save(): JSX.Element {
  const { main, files } = project.value;
  const damaged = damagedText();
  return (
    <Dialog title="Save" onClose={close}>
      <p>Your browser keeps the program too, until you clear its data for this page.</p>
      <ul class="shell-files">
        {damaged === null ? null : (
          <li>
            <button type="button" onClick={() => act().save("kept-program.json", damaged, "application/json")}>
              Save the kept program that could not be read
            </button>
          </li>
        )}
        {Object.entries(files).map(([name, text]) => (
          <li key={name}>
            <button
              type="button"
              class={name === main ? "shell-primary" : ""}
              onClick={() => act().save(name.split("/").pop() ?? name, text, "text/plain")}
            >
              Save {name}
            </button>
          </li>
        ))}
      </ul>
    </Dialog>
  );
}

function Share(): JSX.Element {
  const [link, setLink] = useState("");
  useEffect(() => void shareLink().then(setLink, sayError), []);
  return (
    <Dialog title="Share" onClose={close}>
      <p>
        The link holds the program and the name of a bundled clip; your own clips and the camera stay
        here. The part after # is not sent to any server.
      </p>
      <label class="shell-field">
        <span>Link</span>
        <input type="text" readOnly value={link} onFocus={(event) => event.currentTarget.select()} />
      </label>
      <button
        type="button"
        class="shell-primary"
        disabled={!link}
        onClick={() =>
          void navigator.clipboard.writeText(link).then(
            () => {
              say("The link is in the clipboard");
              close();
            },
            () => sayError(new Error("the browser did not give the clipboard: copy the link from the box")),
          )
        }
      >
        Copy the link
      </button>
      {link.length > 8000 ? (
        <p class="shell-note">This link has {link.length.toLocaleString("en")} letters; some mail programs cut such links. A file is safer.</p>
      ) : null}
    </Dialog>
  );
}
