/** Context keys of VS Code, for the steps of the walkthrough and for menus. */

import * as vscode from "vscode";

/** Say whether the server runs, or that a program has been debugged or the array been seen. */
export function tell(what: "serverRuns" | "debugged" | "arraySeen", is = true): void {
  void vscode.commands.executeCommand("setContext", `npchip.${what}`, is);
}
