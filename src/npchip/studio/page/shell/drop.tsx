/** Files dropped on the page: sources are opened, a machine is used, all else becomes the clip. */

import { heard } from "../say";
import { signal } from "@preact/signals";
import type { ComponentChildren, JSX } from "preact";
import { openAny } from "./open";

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
        heard(openAny([...(event.dataTransfer?.files ?? [])]));
      }}
    >
      {children}
    </div>
  );
}
