/** The program's files: edits, examples, opening, links, keeping. */

import { batch, effect, signal, untracked } from "@preact/signals";
import { fileChanged, forgetFileChange } from "../editor/undo";
import type { Project } from "../protocol";
import { breaks, clip, conditions, library, machine, openFile, project, running, verdicts } from "../store";
import { clipChoice } from "../control/clips";
import { heard, say, sayError } from "../say";
import { bringUp, exchange, halt, mended, run, unlessRest } from "./chip";
import { chooseBundled, chosenClip, isBundled } from "./clips";
import { compileSoon, memory, useCompiled } from "./compile";
import { examples, translated, type Example } from "./examples";
import { type Foreign, foreignProgram, keepProgram } from "./keep";
import { asides, chosenExample, followTabs, setAside } from "./own";
import { toLink, type Shared } from "./share";

/** True if the browser does not keep the program. */
export const unkept = signal(false);

/** Counts what was opened: an answer that comes late, for something else, is dropped. */
let opening = 0;
/** The example whose bytes lie in the NPs' memory. */
let memoryOf: string | null = null;

export function edit(file: string, text: string): void {
  if (project.value.files[file] === text) return;
  changed({ ...project.value, files: { ...project.value.files, [file]: text } });
}

/** Replace the project as it is; the editor keeps what it can undo. */
export function setProject(other: Project): void {
  changed(other);
}

function changed(now: Project): void {
  const editedAt = performance.now();
  leaveLink();
  batch(() => {
    project.value = now;
    if (!(openFile.value in now.files) && !(openFile.value in library.value)) openFile.value = now.main;
    chosenExample.value = "";
    verdicts.value = null;
  });
  compileSoon((result) => {
    if (result.program) mended();
    heard(exchange(result, editedAt));
  });
}

/** Open an example with the clip that shows it best, and run it. */
export async function openExample(name: string, options: { clip?: string | null; start?: boolean } = {}): Promise<void> {
  const found = (await examples()).find((each) => each.name === name);
  if (!found) throw new Error(`there is no example '${name}' in this page`);
  const mine = ++opening;
  const goesOn = unlessRest();
  // A clip that is chosen while the program is fetched is not replaced by the program's own.
  const clipIsFree = clipChoice();
  await halt();
  const ready = await translated(found, machine.value);
  if (mine !== opening) return;
  replace(found.project, found);
  if (ready) useCompiled(ready);
  chosenExample.value = name;
  if (clipIsFree()) await withClip(found, options.clip);
  if (mine !== opening) return;
  if (found.note) {
    await bringUp();
    say(`${name} ${found.note}`);
  } else if ((options.start ?? true) && goesOn()) {
    await run();
    say(`${name}: ${found.summary}`);
  } else await bringUp();
}

async function withClip(example: Example, wanted: string | null | undefined): Promise<void> {
  const name = wanted ?? example.clip;
  if (clip.value === "live" && wanted === undefined) return;
  if (name && name !== chosenClip.value) await chooseBundled(name);
}

/** Show another program: what belongs to the one before goes, an own one is set aside. */
function replace(other: Project, example: Example | null): void {
  const own = chosenExample.peek() ? null : shared();
  setAside(own);
  forgetFileChange();
  const name = own?.project.main ?? "";
  if (own?.project.files[name]?.trim()) {
    fileChanged(`Your ${name} was set aside: the box Example has it.`, () => heard(openShared(own)));
  }
  leaveLink();
  memoryOf = example?.memory.length ? example.name : null;
  batch(() => {
    project.value = other;
    openFile.value = other.main;
    breaks.value = [];
    conditions.value = [];
    verdicts.value = null;
    memory.value = example?.memory ?? [];
    chosenExample.value = "";
  });
}

/** Open a program that was shared or kept; an unchanged example is one again, and may start. */
export async function openShared(found: Shared, start = false): Promise<void> {
  const all = await examples();
  const choice = { name: found.machine, ...(found.machineText === undefined ? {} : { text: found.machineText }) };
  if (JSON.stringify(choice) !== JSON.stringify(machine.peek())) machine.value = choice;
  const same = all.find((each) => isSame(each, found.project));
  if (same) {
    await openExample(same.name, { clip: found.clip, start });
    return;
  }
  const mine = ++opening;
  const clipIsFree = clipChoice();
  await halt();
  if (mine !== opening) return;
  replace(found.project, all.find((each) => each.name === found.memoryOf) ?? null);
  if (found.clip && clipIsFree()) await chooseBundled(found.clip);
  // It may have to wait for the assembler, which the reader need not.
  heard(bringUp());
}

/** Set the kept program aside, unless it is an example as it came. */
export async function setAsideKept(kept: Shared): Promise<void> {
  if (!(await isExample(kept))) setAside(kept);
}

/** Set aside what another tab has kept, unless it is an example as it came. */
async function setAsideForeign({ shared, tab }: Foreign): Promise<void> {
  if (await isExample(shared)) return;
  if (setAside(shared, tab)) say("The studio is open in another tab, too. The program there is in the box Example, under Your programs");
}

async function isExample({ project: found }: Shared): Promise<boolean> {
  return (await examples()).some((each) => isSame(each, found));
}

/** Open a program of the reader again that was set aside, by its place in `asides`. */
export async function openAside(index: number): Promise<void> {
  const found = asides.peek()[index];
  if (!found) return;
  await openShared(found.shared);
  say(`Opened your ${found.shared.project.main}`);
}

/** True if a project is an example as it came; what that includes may be left out. */
function isSame(example: Example, found: Project): boolean {
  const { main, files } = example.project;
  return (
    found.main === main &&
    main in found.files &&
    Object.entries(found.files).every(([name, text]) => files[name] === text)
  );
}

/** Forget the link in the address once the page differs from it: a reload would bring it back. */
export function leaveLink(): void {
  if (location.hash) history.replaceState(null, "", location.pathname + location.search);
}

export async function shareLink(): Promise<string> {
  const link = await toLink(shared());
  return new URL(link, document.baseURI.split("#")[0]).href;
}

function shared(): Shared {
  return {
    project: { ...project.value, files: ownFiles() },
    clip: isBundled() ? chosenClip.value : null,
    machine: machine.value.name,
    ...(machine.value.text === undefined ? {} : { machineText: machine.value.text }),
    ...(memoryOf === null ? {} : { memoryOf }),
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

/** Use sources that were read: files of the program are replaced, others are another program. */
export async function useSources(texts: Record<string, string>): Promise<void> {
  const names = Object.keys(texts);
  const now = project.peek();
  const mine = ++opening;
  if (names.every((name) => name in now.files && name !== now.main)) {
    setProject({ ...now, files: { ...now.files, ...texts } });
    openFile.value = names[0] ?? now.main;
  } else {
    await halt();
    if (mine !== opening) return;
    replace({ main: mainOf(texts), files: texts }, null);
  }
  say(`Opened ${names.join(", ")}`);
  if (!running.peek()) await bringUp();
}

/** The first file that no other one includes. */
function mainOf(texts: Record<string, string>): string {
  const names = Object.keys(texts);
  const included = (name: string): boolean =>
    Object.values(texts).some((text) => text.split("\n").some((line) => line.includes(".include") && line.includes(`"${name}"`)));
  return names.find((name) => !included(name)) ?? names[0] ?? "program.s";
}

/**
 * Keep the program in the browser whenever it changes; tell once if that fails. What another tab
 * has kept since gives way, and is set aside.
 */
export function keepAlways(): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const keep = (now: Shared): void => {
    clearTimeout(timer);
    const foreign = foreignProgram();
    if (foreign) heard(setAsideForeign(foreign));
    try {
      keepProgram(now);
      unkept.value = false;
    } catch (fault) {
      if (!unkept.peek()) sayError(fault);
      unkept.value = true;
    }
  };
  followTabs();
  effect(() => {
    const now = shared();
    clearTimeout(timer);
    timer = setTimeout(keep, 400, now);
  });
  // Keep the last keystrokes before the page goes.
  window.addEventListener("pagehide", () => keep(untracked(shared)));
}
