/** The page: the program on the left, pictures on the right, panels below. */

import type { JSX } from "preact";
import { Travel } from "../array/Travel";
import { Editor } from "../editor/editor";
import { Outputs } from "../results/outputs";
import { Pictures } from "../results/pictures";
import { Dialogs } from "./dialogs";
import { FileDrop } from "./drop";
import { Panels } from "./panels";
import { Messages } from "./messages";
import { Toolbar } from "./toolbar";

export function App(): JSX.Element {
  return (
    <FileDrop>
      <a class="shell-skip" href="#program">
        Skip to the program
      </a>
      <Toolbar />
      <main class="shell-main">
        <h1 class="shell-hidden">npchip studio</h1>
        <section class="shell-program" id="program" aria-label="Program and mistakes">
          <Editor />
        </section>
        <section class="shell-pictures" aria-label="Pictures">
          <Pictures />
        </section>
        <section class="shell-outputs" aria-label="Outputs of each frame">
          <Outputs />
        </section>
        <section class="shell-travel" aria-label="Step">
          <Travel />
        </section>
        <section class="shell-panels" aria-label="Look inside">
          <Panels />
        </section>
      </main>
      <Messages />
      <Dialogs />
    </FileDrop>
  );
}
