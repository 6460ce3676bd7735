/** A program to begin with: it runs, and has a test. */

import * as vscode from "vscode";

/** Frames twice as dark; `tests/editors` assembles it and runs its test. */
export const PROGRAM = `; Every pixel half as bright. The two lines below are a test: npchip test FILE
; run: levels levels=0,1,100,255
; expect: picture == 0, 0, 50, 127
.output picture, 0, picture

frame:  EXPOSE                          ; take the next frame
        SAMPLE  signal, 0               ; its pixels into bytes 0 to 63 of each NP
        MOV     r0, #0
.pixel: LD      r1, [r0]
        SHR     r1, #1
        OUT     0, r1
        ADD     r0, #1
        CMP     r0, #64
        JANY    LO, .pixel
        JMP     frame
`;

/** Open the program as a file that has no name yet. */
export async function newProgram(): Promise<void> {
  const document = await vscode.workspace.openTextDocument({ language: "npchip", content: PROGRAM });
  await vscode.window.showTextDocument(document);
}
