/** The language server, `npchip lsp`: one for the window. */

import { spawn, type ChildProcess } from "node:child_process";
import * as vscode from "vscode";
import { LanguageClient, State } from "vscode-languageclient/node";
import { commandFor, didNotStart } from "./command";
import { tell } from "./progress";

/** Starts the server, again when its command changes, and ends it. */
export class Server implements vscode.Disposable {
  #client: LanguageClient | null = null;
  /** Starts and ends, one after the other. */
  #work: Promise<void> = Promise.resolve();
  readonly #changes: vscode.Disposable;

  constructor() {
    this.#changes = vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("npchip.command")) this.restart();
    });
    this.restart();
  }

  /** End the server that runs, and start one. */
  restart(): void {
    this.#work = this.#work.then(() => this.#end()).then(() => this.#start());
  }

  /** End the server. */
  stop(): Promise<void> {
    this.#work = this.#work.then(() => this.#end());
    return this.#work;
  }

  dispose(): void {
    this.#changes.dispose();
    void this.stop();
  }

  async #start(): Promise<void> {
    const folder = vscode.workspace.workspaceFolders?.[0]?.uri;
    const { program, args } = commandFor(folder);
    const started = (): Promise<ChildProcess> => spawned(program, [...args, "lsp"], folder?.fsPath);
    // The client would say only that there is no connection.
    let first: ChildProcess | null = await started().catch((error: unknown) => {
      void didNotStart("the language server", error);
      return null;
    });
    if (!first) return;
    const client = new LanguageClient(
      "npchip",
      "npchip language server",
      async () => {
        const process = first ?? (await started());
        first = null;
        return process;
      },
      { documentSelector: ["file", "untitled"].map((scheme) => ({ scheme, language: "npchip" })) },
    );
    client.onDidChangeState(({ newState }) => tell("serverRuns", newState === State.Running));
    this.#client = client;
    // The client says why it has failed; the next start is not hindered by it.
    await client.start().catch(() => undefined);
  }

  async #end(): Promise<void> {
    const client = this.#client;
    this.#client = null;
    if (client?.state === State.Running) await client.stop();
    await client?.dispose();
  }
}

/** Start a program; rejects if there is none. */
function spawned(program: string, args: string[], cwd: string | undefined): Promise<ChildProcess> {
  return new Promise((resolve, reject) => {
    const process = spawn(program, args, cwd === undefined ? {} : { cwd });
    process.once("spawn", () => resolve(process));
    process.once("error", reject);
  });
}
