"""The place of the program: calls and macros as frames, sources, disassembly."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path, PurePath
from typing import Any, Final

from npchip.assembler.disassembler import disassemble_word, registers_of
from npchip.base.errors import InputError
from npchip.dap import memory
from npchip.dap.arguments import Arguments
from npchip.dap.session import Session
from npchip.debugger.screen.look import Sources

Body = dict[str, Any]

MOST_INSTRUCTIONS: Final = 4_096
"""Most instructions that are disassembled at once."""


def place(session: Session, file: str, line: int) -> Body:
    """Return a line of a source file as the protocol has it."""
    return {"source": source_of(session, file), "line": line - 1 + session.client.first}


def source_of(session: Session, file: str) -> Body:
    """Return a source file: by its path, or by a number if it is not there any more."""
    source: Body = {"name": PurePath(file).name}
    if Path(file).is_file():
        return source | {"path": str(Path(file).resolve())}
    return source | {"sourceReference": session.debugger.names.files.index(file) + 1}


def _frames(session: Session) -> Iterator[Body]:
    """Yield the open places, the innermost first: the next instruction, then the calls.

    Inside a macro or repetition, the lines that expand it are frames of their own.
    """
    debugger = session.debugger
    chip, program = debugger.chip, debugger.program
    first = session.client.first
    for address in (chip.pc, *(back - 1 for back in reversed(chip.stack))):
        line, name = program.place(address), debugger.names.near(address)
        frame = {"name": name, "instructionPointerReference": memory.address(address)}
        if line is None:
            yield {**frame, "line": 0, "column": 0, "presentationHint": "normal"}
        else:
            for origin in line.origins:
                where = place(session, origin.file, origin.line)
                yield {**frame, **where, "column": first, "presentationHint": "normal"}
                frame["name"] = f"{name} (expanded here)"


def stack_trace(session: Session, arguments: Arguments) -> Body:
    """Return the frames, or some of them."""
    start = arguments.number("startFrame", 0, least=0)
    levels = arguments.number("levels", 0, least=0)
    frames = [{"id": number, **frame} for number, frame in enumerate(_frames(session), 1)]
    end = start + levels if levels else None
    return {"stackFrames": frames[start:end], "totalFrames": len(frames)}


def sources(session: Session, _arguments: Arguments) -> Body:
    """Return the source files that have instructions."""
    return {"sources": [source_of(session, file) for file in session.debugger.names.files]}


def text(session: Session, arguments: Arguments) -> Body:
    """Return the text of a source file that is not there: the lines with instructions.

    Raises:
        InputError: NP358, it is no file of the program.
    """
    found = session.file_of(arguments)
    if found is None:
        raise InputError("NP358", "source: no source file of this program")
    rows = {row.number: row.text for row in Sources(session.debugger).files[found]}
    lines = [rows.get(number, "") for number in range(1, max(rows) + 1)]
    return {"content": "\n".join(lines) + "\n"}


def disassemble(session: Session, arguments: Arguments) -> Body:
    """Return as many instructions as wanted, also before and after the program's."""
    start = memory.rom(arguments.text("memoryReference")) + arguments.number("offset", 0) // 2
    start += arguments.number("instructionOffset", 0)
    count = arguments.number("instructionCount", least=0, most=MOST_INSTRUCTIONS)
    return {"instructions": [_instruction(session, at) for at in range(start, start + count)]}


def _instruction(session: Session, address: int) -> Body:
    program = session.debugger.program
    body: Body = {"address": memory.address(address)}
    if not 0 <= address < len(program.words):
        return {**body, "instruction": "", "presentationHint": "invalid"}
    word = program.words[address]
    isa = session.debugger.chip.isa
    names, registers = program.label_names, registers_of(program, address)
    shown = disassemble_word(word, isa, names, registers) or f".word 0x{word:04X}"
    body |= {"instructionBytes": f"{word:04X}", "instruction": shown}
    if address in names:
        body["symbol"] = names[address]
    line = program.place(address)
    if line is not None:
        where = place(session, line.file, line.line)
        body |= {"location": where["source"], "line": where["line"]}
    return body
