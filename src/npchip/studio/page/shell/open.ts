/** Opening files of any kind, by the button or dropped on the page. */

import { sceneFile } from "../frames/kinds";
import { chooseFiles } from "./clips";
import { chooseMachine } from "./machines";
import { sayError } from "../say";
import { isSource, openSources } from "./sources";

/** Open files: sources are a program, a machine file is used, all else becomes the clip. */
export async function openAny(files: File[]): Promise<void> {
  const sources = files.filter(isSource);
  const machine = files.find(isYaml);
  const others = files.filter((file) => !isSource(file) && !isYaml(file));
  try {
    if (machine) await openYaml(machine);
    if (sources.length) await openSources(sources);
    if (others.length) await chooseFiles(others);
  } catch (fault) {
    sayError(fault);
  }
}

function isYaml(file: File): boolean {
  return /\.ya?ml$/i.test(file.name);
}

/** Keys that a scene has, and no machine. */
const OF_A_SCENE = /^(?:objects|motion|shape)[ \t]*:/m;

async function openYaml(file: File): Promise<void> {
  if (file.size > MOST) throw new Error(`${file.name}: too large for a machine file`);
  const text = await file.text();
  if (OF_A_SCENE.test(text)) throw sceneFile(file.name);
  await chooseMachine({ name: file.name, text });
}

/** Far more than a machine file needs. */
const MOST = 1 << 20;
