/** The debugger, `npchip dap`: how it starts, and what the array hears of it. */

import * as vscode from "vscode";
import type { ArrayPanel } from "./array-panel";
import { commandFor } from "./command";
import { tell } from "./progress";

const TYPE = "npchip";
/** Under which the frames that were named last are kept for the folder. */
const FRAMES = "npchip.frames";

/** Register all that a debug session needs. */
export function debugging(panel: ArrayPanel, memory: vscode.Memento): vscode.Disposable[] {
  return [
    vscode.debug.registerDebugAdapterDescriptorFactory(TYPE, { createDebugAdapterDescriptor: adapter }),
    vscode.debug.registerDebugConfigurationProvider(TYPE, { resolveDebugConfiguration: completed }),
    vscode.debug.registerDebugAdapterTrackerFactory(TYPE, {
      createDebugAdapterTracker: (session) => ({ onDidSendMessage: (message) => hear(message, session, panel) }),
    }),
    vscode.debug.onDidTerminateDebugSession((session) => panel.ended(session)),
    vscode.commands.registerCommand("npchip.debugFile", debugFile),
    vscode.commands.registerCommand("npchip.askFrames", () => askFrames(memory)),
  ];
}

function adapter(session: vscode.DebugSession): vscode.DebugAdapterDescriptor {
  const folder = session.workspaceFolder?.uri;
  const { program, args } = commandFor(folder);
  return new vscode.DebugAdapterExecutable(program, [...args, "dap"], folder ? { cwd: folder.fsPath } : {});
}

/** Without a launch file the program that is shown is meant. */
function completed(
  _folder: vscode.WorkspaceFolder | undefined,
  given: vscode.DebugConfiguration,
): vscode.DebugConfiguration | undefined {
  if (given.type) return given;
  if (vscode.window.activeTextEditor?.document.languageId !== "npchip") return undefined;
  return THIS_PROGRAM;
}

const THIS_PROGRAM: vscode.DebugConfiguration = {
  type: TYPE,
  request: "launch",
  name: "Debug this program",
  program: "${file}",
  frames: "${command:askFrames}",
  stopOnEntry: true,
};

/** Debug the program that is shown, saved. */
async function debugFile(): Promise<void> {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId !== "npchip") {
    await vscode.window.showInformationMessage("npchip: show a program first.");
  } else if (document.isUntitled && !(await document.save())) {
    await vscode.window.showInformationMessage("npchip: save the program first, as a file that ends in .s.");
  } else {
    await vscode.debug.startDebugging(vscode.workspace.getWorkspaceFolder(document.uri), THIS_PROGRAM);
  }
}

/** Ask what the sensor sees; undefined, which stops the start, if the reader gives up. */
async function askFrames(memory: vscode.Memento): Promise<string | undefined> {
  const frames = await vscode.window.showInputBox({
    title: "Frames",
    prompt: "What the sensor sees: a file, a folder, or the name of a clip; empty for no frames",
    value: memory.get(FRAMES, "ball_fall_30000fps"),
    ignoreFocusOut: true,
  });
  if (frames !== undefined) await memory.update(FRAMES, frames.trim());
  return frames?.trim();
}

interface Message {
  type?: string;
  event?: string;
}

function hear({ type, event }: Message, session: vscode.DebugSession, panel: ArrayPanel): void {
  if (type !== "event") return;
  if (event === "stopped") tell("debugged");
  if (event === "stopped" || event === "invalidated") void panel.stopped(session);
  if (event === "continued") panel.continued(session);
}
