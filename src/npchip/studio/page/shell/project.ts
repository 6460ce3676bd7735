/** The program's files: edits, examples, opening, saving, sharing, keeping. */

import { batch, effect, signal } from "@preact/signals";
import type { Project } from "../protocol";
import { breaks, clip, conditions, library, machine, openFile, project } from "../store";
import { bringUp, put, stale, run } from "./chip";
import { chooseBundled, chosenClip, give } from "./clips";
import { compileNow, compileSoon, memory, useCompiled } from "./compile";
import { examples, translated, type Example } from "./examples";
import { keepProgram } from "./keep";
import { running } from "../store";
import { say, sayError } from "./say";
import { isName, toLink, type Shared } from "./share";

/** What the box `Example` shows: the name of an unchanged example, or nothing. */
export const chosenExample = signal("");

const SOURCE = /\.(s|asm|inc|txt)$/i;
/** The assembler's limit for a source with its includes. */
const MOST = 1 << 18;

export function edit(file: string, text: string): void {
  if (project.value.files[file] === text) return;
  batch(() => {
    project.value = { ...project.value, files: { ...project.value.files, [file]: text } };
    chosenExample.value = "";
    stale.value = true;
  });
  compileSoon((result) => {
    if (running.value && result.program) void put(result).then(run);
  });
}

/** Replace the project as it is; the editor keeps what it can undo. */
export function setProject(changed: Project): void {
  batch(() => {
    project.value = changed;
    if (!(openFile.value in changed.files)) openFile.value = changed.main;
    chosenExample.value = "";
    stale.value = true;
  });
  compileSoon(() => undefined);
}

/** Open an example with the clip that shows it best, and run it. */
export async function openExample(name: string, options: { clip?: string | null; start?: boolean } = {}): Promise<void> {
  const found = (await examples()).find((each) => each.name === name);
  if (!found) throw new Error(`there is no example '${name}' in this page`);
  running.value = false;
  batch(() => {
    project.value = found.project;
    openFile.value = found.project.main;
    breaks.value = [];
    conditions.value = [];
    memory.value = found.memory;
  });
  const ready = await translated(found, machine.value.name);
  if (ready) useCompiled(ready);
  else await compileNow();
  stale.value = ready === null;
  chosenExample.value = name;
  await withClip(found, options.clip);
  if (found.note) say(`${name} ${found.note}`);
  else if (options.start ?? true) await run();
  else await bringUp();
}

async function withClip(example: Example, wanted: string | null | undefined): Promise<void> {
  const name = wanted ?? example.clip;
  if (clip.value === "live" && wanted === undefined) return;
  if (name && name !== chosenClip.value) await chooseBundled(name);
}

/** Open a program that was shared or kept. */
export async function openShared(shared: Shared): Promise<void> {
  batch(() => {
    project.value = shared.project;
    openFile.value = shared.project.main;
    machine.value = { name: shared.machine };
    chosenExample.value = "";
    stale.value = true;
  });
  if (shared.clip) await chooseBundled(shared.clip);
}

export async function shareLink(): Promise<string> {
  const link = await toLink(shared());
  return new URL(link, document.baseURI.split("#")[0]).href;
}

function shared(): Shared {
  const bundled = !["", "own", "camera", "scene"].includes(chosenClip.value);
  return {
    project: { ...project.value, files: ownFiles() },
    clip: bundled ? chosenClip.value : null,
    machine: machine.value.text === undefined ? machine.value.name : "default",
  };
}

/** The project's files but those that are as in the library. */
function ownFiles(): Record<string, string> {
  const { main, files } = project.value;
  const own = Object.entries(files).filter(([name, text]) => name === main || library.value[name] !== text);
  return Object.fromEntries(own);
}

/** Fetch what programs may include, so that a program can be kept and sent without it. */
export async function fillLibrary(): Promise<void> {
  const parts = (await examples()).map(({ project: { main, files } }) =>
    Object.entries(files).filter(([name]) => name !== main),
  );
  library.value = Object.fromEntries(parts.flat());
}

/** Open sources from the reader's disk: the first becomes the program, the others its includes. */
export async function openSources(files: File[]): Promise<void> {
  const texts: Record<string, string> = {};
  let total = 0;
  for (const file of files) {
    total += file.size;
    if (total > MOST) {
      sayError(new Error(`${file.name}: sources of more than ${MOST >> 10} KiB cannot be assembled`));
      return;
    }
    if (!isName(file.name)) {
      sayError(new Error(`'${file.name}' cannot name a source: use letters, digits, '_', '-' and '.'`));
      return;
    }
    try {
      texts[file.name] = new TextDecoder("utf-8", { fatal: true }).decode(await file.arrayBuffer());
    } catch {
      sayError(new Error(`${file.name} is not a text in UTF-8: save it as UTF-8 and open it again`));
      return;
    }
  }
  const main = Object.keys(texts)[0];
  if (!main) return;
  batch(() => {
    project.value = { main, files: { ...project.value.files, ...texts } };
    openFile.value = main;
    chosenExample.value = "";
    stale.value = true;
  });
  say(`Opened ${Object.keys(texts).join(", ")}`);
  await compileNow();
}

export function isSource(file: File): boolean {
  return SOURCE.test(file.name);
}

/** Keep the program in the browser whenever it changes; tell once if that fails. */
export function keepAlways(): void {
  let told = false;
  let timer: ReturnType<typeof setTimeout> | undefined;
  effect(() => {
    const now = shared();
    clearTimeout(timer);
    timer = setTimeout(() => {
      try {
        keepProgram(now);
        told = false;
      } catch (fault) {
        if (!told) sayError(fault);
        told = true;
      }
    }, 400);
  });
}

export { give };
