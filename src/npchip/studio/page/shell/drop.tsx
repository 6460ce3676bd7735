/** Files dropped on the page: sources are opened, a machine is used, all else becomes the clip. */

import { signal } from "@preact/signals";
import type { ComponentChildren, JSX } from "preact";
import { chooseFiles } from "./clips";
import { chooseMachine } from "./machines";
import { isSource, openSources } from "./sources";

const over = signal(false);

export function FileDrop({ children }: { children: ComponentChildren }): JSX.Element {
  const hasFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") ?? false;
  return (
    <div
      class="shell-page"
      data-over={over.value || undefined}
      onDragOver={(event) => {
        if (!hasFiles(event)) return;
        event.preventDefault();
        over.value = true;
      }}
      onDragLeave={() => {
        over.value = false;
      }}
      onDrop={(event) => {
        if (!hasFiles(event)) return;
        event.preventDefault();
        over.value = false;
        void take([...(event.dataTransfer?.files ?? [])]);
      }}
    >
      {children}
    </div>
  );
}

/** Open files of any kind. */
async function take(files: File[]): Promise<void> {
  const sources = files.filter(isSource);
  const machine = files.find(isMachine);
  const others = files.filter((file) => !isSource(file) && !isMachine(file));
  if (machine) await chooseMachine({ name: machine.name, text: await machine.text() });
  if (sources.length) await openSources(sources);
  if (others.length) await chooseFiles(others);
}

function isMachine(file: File): boolean {
  return /\.ya?ml$/i.test(file.name);
}
