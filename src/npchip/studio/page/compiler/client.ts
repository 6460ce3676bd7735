/** The compiler as the page sees it: calls a worker, and starts another one if that is lost. */

import type {
  Bounds,
  Clip,
  CompileRequest,
  Compiled,
  Compiler,
  ConditionTree,
  Diagnostic,
  Language,
  MachineChoice,
  MemoryPart,
  Quantity,
  RunDocument,
  TestRun,
  Verdict,
} from "../protocol";
import type { Answer, FromWorker, Loading, ToWorker } from "./messages";

export type { Loading } from "./messages";

/** A compiler that can be stopped. */
export interface CompilerClient extends Compiler {
  /** Stop all work at once: what was asked is rejected. The next call starts a worker anew. */
  terminate(): void;
}

interface Waiting {
  resolve(value: unknown): void;
  reject(error: Error): void;
}

/**
 * Make a compiler. It loads at once; calls wait until it is there.
 *
 * @param start - returns a new worker of `worker.ts`; a worker itself cannot be started again.
 * @param onProgress - hears how far loading is, and null when it is done or has failed.
 */
export function createCompiler(
  start: Worker | (() => Worker),
  onProgress: (loading: Loading | null) => void,
): CompilerClient {
  return new Client(start, onProgress);
}

class Client implements CompilerClient {
  #worker: Worker | null = null;
  #next = 0;
  readonly #waiting = new Map<number, Waiting>();
  readonly #start: () => Worker;

  constructor(
    start: Worker | (() => Worker),
    readonly onProgress: (loading: Loading | null) => void,
  ) {
    this.#start = typeof start === "function" ? start : once(start);
    this.#begin();
  }

  language(): Promise<Language> {
    return this.#call("language") as Promise<Language>;
  }

  compile(request: CompileRequest): Promise<Compiled> {
    return this.#request("compile", request) as Promise<Compiled>;
  }

  async whole(request: CompileRequest): Promise<Uint8Array<ArrayBuffer>> {
    const { module } = (await this.#request("whole", request)) as Pick<Compiled, "module">;
    if (!module) throw new Error("the compiler made no module");
    return module;
  }

  bounds(): Promise<Bounds | null> {
    return this.#call("bounds") as Promise<Bounds | null>;
  }

  condition(text: string): Promise<ConditionTree> {
    return this.#call("condition", [text]) as Promise<ConditionTree>;
  }

  writers(value: Quantity): Promise<number[]> {
    return this.#call("writers", [value]) as Promise<number[]>;
  }

  async tests(request: CompileRequest): Promise<{ runs: TestRun[]; diagnostics: Diagnostic[] }> {
    const found = (await this.#request("tests", request)) as {
      runs: (Omit<TestRun, "memory"> & { memory: Packed[] })[];
      diagnostics: Diagnostic[];
    };
    return { ...found, runs: found.runs.map((run) => ({ ...run, memory: run.memory.map(unpacked) })) };
  }

  judge(run: string, machine: string, result: RunDocument): Promise<Verdict[]> {
    return this.#call("judge", [run, machine, result]) as Promise<Verdict[]>;
  }

  scene(text: string, machine: MachineChoice): Promise<Clip> {
    return this.#call("scene", [text, machine]) as Promise<Clip>;
  }

  terminate(): void {
    this.#lose("The compiler was stopped");
  }

  #request(method: string, request: CompileRequest): Promise<unknown> {
    const blobs = request.memory.map((part) => part.data);
    const memory = request.memory.map((part, data) => ({ ...part, data }));
    return this.#call(method, [{ ...request, memory }], blobs);
  }

  #call(method: string, args: unknown[] = [], blobs: Uint8Array[] = []): Promise<unknown> {
    return new Promise((resolve, reject) => {
      const worker = this.#worker ?? this.#begin();
      const id = this.#next++;
      this.#waiting.set(id, { resolve, reject });
      worker.postMessage({ id, method, args: JSON.stringify(args), blobs } satisfies ToWorker);
    });
  }

  #begin(): Worker {
    const worker = this.#start();
    this.#worker = worker;
    worker.onmessage = (event: MessageEvent<FromWorker>) => {
      if (worker === this.#worker) this.#hear(event.data);
    };
    worker.onerror = (event) => {
      if (worker === this.#worker) this.#lose(`The compiler broke down: ${event.message}`);
    };
    worker.postMessage({ base: document.baseURI } satisfies ToWorker);
    return worker;
  }

  #hear(message: FromWorker): void {
    if (message.kind === "loading") this.onProgress(message.loading);
    else if (message.kind === "ready") this.onProgress(null);
    else if (message.kind === "failed") this.#lose(message.message);
    else {
      const waiting = this.#waiting.get(message.id);
      this.#waiting.delete(message.id);
      const answer = JSON.parse(message.text) as Answer;
      if ("error" in answer) waiting?.reject(new Error(answer.error));
      else if (message.module) waiting?.resolve({ ...(answer.value as object), module: message.module });
      else waiting?.resolve(answer.value);
    }
  }

  #lose(message: string): void {
    this.#worker?.terminate();
    this.#worker = null;
    this.onProgress(null);
    const lost = [...this.#waiting.values()];
    this.#waiting.clear();
    for (const { reject } of lost) reject(new Error(message));
  }
}

/** A part of the memory as JSON holds it: its data in base64. */
type Packed = Omit<MemoryPart, "data"> & { data: string };

function unpacked(part: Packed): MemoryPart {
  return { ...part, data: Uint8Array.from(atob(part.data), (letter) => letter.charCodeAt(0)) };
}

function once(worker: Worker): () => Worker {
  let given = false;
  return () => {
    if (given) throw new Error("The compiler was stopped: load the page again");
    given = true;
    return worker;
  };
}
