/** Data that `npchip export` put into the page. */

import type { Clip, ProgramInfo } from "../protocol";
import type { Guide } from "../results/guide";

/** The data of the page as they stand in it; bytes are compressed and in base64. */
interface Packed {
  title: string;
  program: ProgramInfo;
  module: string;
  maxCycles: number;
  guide: Guide | null;
  clip: (Omit<Clip, "data"> & { data: string }) | null;
}

export interface Exported {
  title: string;
  program: ProgramInfo;
  module: Uint8Array<ArrayBuffer>;
  maxCycles: number;
  guide: Guide | null;
  clip: Clip | null;
}

/** Read the data of this page. */
export async function readData(): Promise<Exported> {
  const packed = JSON.parse(textOf("data")) as Packed;
  return {
    ...packed,
    module: await unpack(packed.module),
    clip: packed.clip && { ...packed.clip, data: await unpack(packed.clip.data) },
  };
}

/** Address of the worker's code; one is enough, however often the worker is started. */
let address = "";

/** Start the chip's worker, whose code stands in this page: a file may not load another one. */
export function startWorker(): Worker {
  if (!address) {
    const code = JSON.parse(textOf("machine")) as string;
    address = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
  }
  return new Worker(address, { name: "chip" });
}

function textOf(id: string): string {
  const text = document.getElementById(id)?.textContent;
  if (!text) throw new Error(`this page has no ${id}: it is not whole, so export it again`);
  return text;
}

async function unpack(text: string): Promise<Uint8Array<ArrayBuffer>> {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
