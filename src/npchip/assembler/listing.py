"""The listing: every source line with its addresses, words and cycles."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

from npchip.assembler.disassembler import disassemble_word, registers_of
from npchip.assembler.sources import MAX_BYTES, split_lines
from npchip.base.files import read_bytes
from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.model import Program, SourceLine

_INDENT = "  "


def listing(
    program: Program, texts: Mapping[str, Sequence[str]], machines: Sequence[Machine], isa: Isa
) -> str:
    """Return the source of a program, each line with its addresses, words and cycles.

    Args:
        program: the program, with its source lines.
        texts: lines of each source file that can be read; of other files only the lines that
            became words are shown.
        machines: the machines, with a column for the cycles of each. A count is that of one
            execution; a conditional jump takes as long whether it jumps or not.
        isa: the program's instruction set.
    """
    room = machines[0].rom_words
    head = [f"; {program.name}: {len(program.words)} words, {room - len(program.words)} left"]
    head.append("; cyc: cycles each time; left: words that are free behind it")
    if len(machines) > 1:
        names = ", ".join(machine.name for machine in machines)
        head.append(f"; cycles: {names}")
    cycles = " ".join(f"{'cyc':>4}" for _ in machines)
    names = f"addr  word  {cycles}  left"
    head.append(f"{names}   line  source")

    costs = list(zip(*(program.cycles(machine, isa) for machine in machines), strict=True))

    def columns(address: int) -> str:
        word = program.words[address]
        shown = " ".join(f"{cost or '-':>4}" for cost in costs[address])
        return f"{address:03X}   {word:04X}  {shown}  {room - address - 1:4d}"

    lines = [*head, *source_beside(program, texts, isa, columns, len(names))]
    return "\n".join(line.rstrip() for line in lines) + "\n"


def source_beside(
    program: Program,
    texts: Mapping[str, Sequence[str]],
    isa: Isa,
    columns: Callable[[int], str],
    width: int,
) -> Iterator[str]:
    """Yield the lines of the source; those that became words have columns in front.

    Args:
        program: the program, with its source lines.
        texts: as for `listing`.
        isa: the program's instruction set.
        columns: returns the columns of an address.
        width: width of the columns.
    """
    labels = {address: name for name, address in program.labels.items()}

    def numbered(line: SourceLine) -> str:
        return f"{line.line:5d}  {line.text}".rstrip()

    if not program.source:
        for address, word in enumerate(program.words):
            yield f"{columns(address)}  {disassemble_word(word, isa, labels) or 'undefined'}"
    for item in _walk(program, texts):
        if isinstance(item, str):
            yield item
        elif isinstance(item, SourceLine):
            yield f"{'':{width}}  {numbered(item)}"
        else:
            address, direct = item
            line = program.source[address]
            if direct:
                yield f"{columns(address):<{width}}  {numbered(line)}"
            else:
                # The word shows the values of parameters and counters.
                known = registers_of(program, address)
                text = disassemble_word(program.words[address], isa, labels, known) or "undefined"
                depth = _INDENT * (len(line.origins) - 1)
                yield f"{columns(address):<{width}}  {line.line:5d}+ {depth}{text}"


def read_texts(program: Program) -> dict[str, list[str]]:
    """Return the lines of each source file that has not changed since the program was assembled."""
    texts: dict[str, list[str]] = {}
    for line in program.source:
        written = line.written_at
        if written.file not in texts:
            try:
                text = read_bytes(Path(written.file), MAX_BYTES).decode("utf-8-sig")
            except (OSError, UnicodeDecodeError):
                text = ""
            texts[written.file] = split_lines(text)
            if text.endswith(("\r", "\n")):
                texts[written.file].pop()
        lines = texts[written.file]
        if written.line > len(lines) or lines[written.line - 1] != written.text:
            texts[written.file] = []  # another text, whose lines belong to other words
    return {file: lines for file, lines in texts.items() if lines}


def _walk(
    program: Program, texts: Mapping[str, Sequence[str]]
) -> Iterator[str | SourceLine | tuple[int, bool]]:
    """Yield headings, lines without words, and addresses (True: of their own line), in order."""
    shown: dict[str, int] = {}  # lines shown so far of each file
    ends = _block_ends(program)
    current = None
    for address, line in enumerate(program.source):
        written = line.written_at
        if written.file != current:
            current = written.file
            yield f"; {current}"
        done = shown.get(current, 0)
        direct = line is written and written.line > done
        # The lines of a repetition come before its words.
        last = written.line - 1 if direct else max(written.line, ends.get(written, 0))
        yield from _plain(current, texts, done, last)
        if not direct and last > done and current not in texts:
            yield written
        yield address, direct
        shown[current] = max(done, last, written.line)
    for file, done in shown.items():
        yield from _plain(file, texts, done, len(texts.get(file, ())))


def _block_ends(program: Program) -> dict[SourceLine, int]:
    """Return, for each line that was expanded, the last line of its file that it expanded to."""
    ends: dict[SourceLine, int] = {}
    for line in program.source:
        *inner, written = line.origins
        for item in inner:
            if item.file == written.file:
                ends[written] = max(ends.get(written, 0), item.line)
    return ends


def _plain(
    file: str, texts: Mapping[str, Sequence[str]], done: int, last: int
) -> Iterator[SourceLine]:
    for number, text in enumerate(texts.get(file, ())[done:last], done + 1):
        yield SourceLine(file, number, text)
