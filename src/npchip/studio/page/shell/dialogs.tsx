/** Dialogs: fit a clip, draw a scene, save, share, help. */

import { signal } from "@preact/signals";
import { useEffect, useId, useRef, useState } from "preact/hooks";
import type { ComponentChildren, JSX } from "preact";
import { act } from "../actions";
import { fitQuestion } from "../control/clips";
import { encodeNpy, npyName } from "../frames/save";
import { SceneEditor } from "../frames/scene";
import { project } from "../store";
import { heard, say, sayError } from "../say";
import { chooseFiles, frameSize, sceneOpen } from "./clips";
import { damagedText } from "./keep";
import { Help } from "./help";
import { leaveLink, shareLink } from "./project";
import { drawing, drawn, useScene } from "./scenes";

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
  const title = useId(); // two dialogs may be open
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
      aria-labelledby={title}
      onClose={props.onClose}
    >
      <header>
        <h2 id={title}>{props.title}</h2>
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
    <Dialog title="The clip has a different size" onClose={cancel}>
      <p>{text}</p>
      <div class="shell-group">
        <button type="button" class="shell-primary" onClick={() => heard(chooseFiles(files, "resize"))}>
          Resize
        </button>
        <button type="button" disabled={!canCrop} onClick={() => heard(chooseFiles(files, "crop"))}>
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
        before={drawing()}
        onChange={drawn}
        onUse={() => {
          shut();
          leaveLink();
          heard(useScene());
        }}
        onSave={(clip) => act().save(npyName(clip), encodeNpy(clip), "application/octet-stream")}
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
  useEffect(() => heard(shareLink().then(setLink)), []);
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
          heard(
            navigator.clipboard.writeText(link).then(
              () => {
                say("Link copied");
                close();
              },
              () => sayError(new Error("The browser blocked the clipboard: copy the link from the box")),
            ),
          )
        }
      >
        Copy the link
      </button>
      {link.length > 8000 ? (
        <p class="shell-note">
          This link is {link.length.toLocaleString("en")} characters long; some mail programs cut long links. Sending a
          file is safer.
        </p>
      ) : null}
    </Dialog>
  );
}
