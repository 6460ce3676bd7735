/** Tasks: assemble, run and profile the program that is shown, test a folder. */

import * as vscode from "vscode";
import { commandFor } from "./command";

interface Definition extends vscode.TaskDefinition {
  command: string;
  args?: string[];
}

/** Offer the tasks. */
export function tasks(): vscode.Disposable {
  return vscode.tasks.registerTaskProvider("npchip", {
    provideTasks: () => [...ofTheFile(), ...ofTheFolders()],
    resolveTask: (task) => made(task.definition as Definition, task.name, task.scope, task.definition),
  });
}

function* ofTheFile(): Iterable<vscode.Task> {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId !== "npchip" || document.uri.scheme !== "file") return;
  const folder = vscode.workspace.getWorkspaceFolder(document.uri);
  const file = vscode.workspace.asRelativePath(document.uri, false);
  for (const command of ["asm", "run", "profile"]) {
    const definition: Definition = { type: "npchip", command, args: [document.uri.fsPath] };
    const task = made(definition, `${command} ${file}`, folder ?? vscode.TaskScope.Workspace);
    if (command === "asm") task.group = vscode.TaskGroup.Build;
    yield task;
  }
}

function* ofTheFolders(): Iterable<vscode.Task> {
  for (const folder of vscode.workspace.workspaceFolders ?? []) {
    const task = made({ type: "npchip", command: "test", args: ["."] }, `test ${folder.name}`, folder);
    task.group = vscode.TaskGroup.Test;
    yield task;
  }
}

/** VS Code knows a task that it has resolved by its definition, so that one must be the same object. */
function made(
  definition: Definition,
  name: string,
  scope: vscode.WorkspaceFolder | vscode.TaskScope | undefined,
  same: vscode.TaskDefinition = definition,
): vscode.Task {
  const folder = typeof scope === "object" ? scope : vscode.workspace.workspaceFolders?.[0];
  const { program, args } = commandFor(folder?.uri);
  const words = [...args, definition.command, ...(definition.args ?? [])];
  const execution = new vscode.ProcessExecution(program, words, folder ? { cwd: folder.uri.fsPath } : {});
  return new vscode.Task(same, scope ?? vscode.TaskScope.Workspace, name, "npchip", execution, ["$npchip"]);
}
