/** The program that serves the editor. */

import * as vscode from "vscode";

/** A program with its first arguments. */
export interface Command {
  program: string;
  args: string[];
}

/** Return the command for a file or folder: the setting, with its folder put in. */
export function commandFor(resource?: vscode.Uri): Command {
  const setting = vscode.workspace.getConfiguration("npchip", resource ?? null);
  const words = setting.get<string[]>("command") ?? [];
  const folder = (resource && vscode.workspace.getWorkspaceFolder(resource)) ?? vscode.workspace.workspaceFolders?.[0];
  const [program = "npchip", ...args] = words.map((word) =>
    word.replaceAll("${workspaceFolder}", folder?.uri.fsPath ?? ""),
  );
  return { program, args };
}

/** Say that the command did not start, and offer what helps. */
export async function didNotStart(what: string, why: unknown): Promise<void> {
  const reason = why instanceof Error ? why.message : String(why);
  const text =
    `npchip: ${what} did not start (${reason}). Install it with: pip install "npchip[editors]", ` +
    "or say in the setting npchip.command where it is.";
  const chosen = await vscode.window.showErrorMessage(text, "Open the Setting");
  if (chosen) await vscode.commands.executeCommand("workbench.action.openSettings", "npchip.command");
}
