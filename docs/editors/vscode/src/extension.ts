/** The extension: what starts with a program, and ends with the window. */

import * as vscode from "vscode";
import { ArrayPanel } from "./array-panel";
import { debugging } from "./debugging";
import { newProgram } from "./new-program";
import { Server } from "./server";
import { tasks } from "./tasks";

let server: Server | null = null;

/** Start all parts; those that start a program wait until the folder is trusted. */
export function activate(context: vscode.ExtensionContext): void {
  const panel = new ArrayPanel(context.extensionUri);
  context.subscriptions.push(
    panel,
    vscode.commands.registerCommand("npchip.showArray", () => panel.show()),
    vscode.commands.registerCommand("npchip.newProgram", newProgram),
  );
  const start = (): void => {
    server = new Server();
    context.subscriptions.push(
      server,
      vscode.commands.registerCommand("npchip.restartServer", () => server?.restart()),
      ...debugging(panel, context.workspaceState),
      tasks(),
    );
  };
  if (vscode.workspace.isTrusted) start();
  else context.subscriptions.push(vscode.workspace.onDidGrantWorkspaceTrust(start));
}

/** End the language server before the window closes. */
export function deactivate(): Promise<void> | undefined {
  return server?.stop();
}
