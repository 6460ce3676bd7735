/** Messages between the page and the compiler's worker. */

/** The first message to the worker: where the page is, beside which Pyodide lies. */
export interface Begin {
  base: string;
}

/** A call of a method of `Compiler`; `blobs` are the bytes that `args` names by index. */
export interface Call {
  id: number;
  method: string;
  /** The list of arguments, as JSON. */
  args: string;
  blobs: Uint8Array[];
}

/** Progress of loading: `share` is 0 to 1, or null if unknown. */
export interface Loading {
  text: string;
  share: number | null;
}

export type ToWorker = Begin | Call;
export type FromWorker =
  | { kind: "loading"; loading: Loading }
  | { kind: "ready" }
  /** Loading failed, or Python crashed: the worker is of no use any more. */
  | { kind: "failed"; message: string }
  | { kind: "answer"; id: number; text: string; module: Uint8Array<ArrayBuffer> | null };

/** An answer's JSON: a value, or why there is none: `forgotten` if Python remembers another program. */
export type Answer = { value: unknown } | { error: string; forgotten: boolean };
