/** The array beside the editor: a web view that follows the debug session which is shown. */

import { randomBytes } from "node:crypto";
import * as vscode from "vscode";
import type { FromPanel, Message, ProgramInfo, ToPanel } from "./array/messages";
import { ask, choose, look, programOf } from "./chip";
import { tell } from "./progress";

/** Opens at the first stop or by command, and shows the chip at each stop. */
export class ArrayPanel implements vscode.Disposable {
  #panel: vscode.WebviewPanel | null = null;
  #session: vscode.DebugSession | null = null;
  /** The program of the session, once the panel has it. */
  #program: ProgramInfo | null = null;
  /** True if the session that is shown stands still. */
  #stopped = false;
  /** Grows with all that makes what is still being read old. */
  #moment = 0;
  readonly #home: vscode.Uri;

  constructor(home: vscode.Uri) {
    this.#home = home;
  }

  dispose(): void {
    this.#panel?.dispose();
  }

  /** Open the panel, or bring it to the front. */
  show(): void {
    if (this.#panel) {
      this.#panel.reveal(undefined, true);
      return;
    }
    const where = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    const options = { enableScripts: true, retainContextWhenHidden: true, localResourceRoots: [this.#home] };
    const panel = vscode.window.createWebviewPanel("npchip.array", "npchip array", where, options);
    this.#panel = panel;
    panel.onDidDispose(() => {
      this.#panel = null;
    });
    panel.webview.onDidReceiveMessage((said: FromPanel) => void this.#hear(said));
    panel.webview.html = this.#page(panel.webview);
    tell("arraySeen");
  }

  /** A session has stopped: show its chip. */
  async stopped(session: vscode.DebugSession): Promise<void> {
    const first = session !== this.#session;
    this.#session = session;
    this.#stopped = true;
    const wanted = vscode.workspace.getConfiguration("npchip").get("array.open") === "first stop";
    if (first && wanted && !this.#panel) this.show(); // it asks for the program when it is ready
    else if (first) await this.#begin();
    else await this.#refresh();
  }

  /** A session goes on. */
  continued(session: vscode.DebugSession): void {
    if (session !== this.#session) return;
    this.#stopped = false;
    this.#moment++;
    this.#say({ kind: "running" });
  }

  /** A session has ended: what it showed last stays. */
  ended(session: vscode.DebugSession): void {
    if (session !== this.#session) return;
    this.#session = null;
    this.#stopped = false;
    this.#moment++;
  }

  #say(message: ToPanel): void {
    void this.#panel?.webview.postMessage(message);
  }

  async #hear(said: FromPanel): Promise<void> {
    const session = this.#session;
    if (said.kind === "ready") await this.#begin();
    else if (said.kind === "addCondition") this.#say({ kind: "answer", id: said.id, wrong: addCondition(said.text) });
    else if (!session) this.#say({ kind: "said", message: { kind: "error", text: "No program is debugged." } });
    // A program that runs refuses the choice: no variables are shown then.
    else if (said.kind === "choose") await choose(session, said.row, said.column).catch(() => undefined);
    else {
      const answer = ask(session, `who ${said.text}`).then(info, error);
      this.#say({ kind: "said", message: await answer });
    }
  }

  /** Show the program of the session, then its chip. */
  async #begin(): Promise<void> {
    this.#program = null;
    await this.#refresh();
  }

  /** Show the chip, unless the session has gone on before all is read. */
  async #refresh(): Promise<void> {
    const session = this.#session;
    if (!session || !this.#panel || !this.#stopped) return;
    const moment = ++this.#moment;
    try {
      const program = this.#program ?? (await programOf(session));
      const view = await look(session, program);
      if (moment !== this.#moment) return;
      if (program !== this.#program) this.#say({ kind: "program", program });
      this.#program = program;
      this.#say({ kind: "view", view });
    } catch (fault) {
      if (moment !== this.#moment) return;
      this.#say({ kind: "said", message: error(fault) });
    }
  }

  #page(webview: vscode.Webview): string {
    const address = (name: string): string => webview.asWebviewUri(vscode.Uri.joinPath(this.#home, name)).toString();
    const nonce = randomBytes(16).toString("base64url");
    const policy = `default-src 'none'; script-src 'nonce-${nonce}'; style-src ${webview.cspSource}`;
    return `<!DOCTYPE html>
<html lang="en">
  <head>
    <meta charset="utf-8">
    <meta http-equiv="Content-Security-Policy" content="${policy}">
    <title>npchip array</title>
    <link rel="stylesheet" href="${address("panel-style.css")}">
  </head>
  <body><script nonce="${nonce}" src="${address("panel.js")}"></script></body>
</html>`;
  }
}

/** Let the debugger stop where a condition holds; the adapter checks it, and marks one it cannot read. */
function addCondition(text: string): string | null {
  vscode.debug.addBreakpoints([new vscode.FunctionBreakpoint(text)]);
  return null;
}

function info(text: string): Message {
  return { kind: "info", text };
}

function error(fault: unknown): Message {
  return { kind: "error", text: fault instanceof Error ? fault.message : String(fault) };
}
