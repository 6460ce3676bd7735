"""Random programs with valid control flow, and the machines, states and frames to run them on.

Drawn from any `random.Random`: from Hypothesis, which shrinks what fails, or from a seed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random
from typing import TYPE_CHECKING

from tests.support.random_cases import Case, Partnership
from tests.support.random_loops import draw_loop, plain_loop
from tests.support.random_machines import draw_machine
from tests.support.random_pictures import Names, draw_picture

if TYPE_CHECKING:
    from npchip import Machine
    from npchip.isa import Isa

CONDITIONS = ("EQ", "NE", "LO", "HS", "HI", "LS")
More = Callable[[Random, Callable[[], str]], str]
COUNTERS = ("r15", "r14", "r13", "r12", "r11")
"""They count loops: the first three those of the program, the others those of its routines."""
OWN = 3
PARTNERS: Sequence[Partnership] = ("sends", "sends", "sends", "sends", "stops", "missing")
FREE = 3
"""First port that no program declares as a picture."""
NO_LIMIT = 50_000_000


@dataclass(frozen=True)
class Style:
    """The kind of programs to draw.

    Attributes:
        statements: most statements.
        work: instructions that they should be when executed, by and large.
        passes: of a loop together with those around it.
        plain: loops only count down, all of them end, and there are no inputs.
        wild: loops whose counters the program may change, jumps into loops, recursion, words
            that mean nothing: most such programs end at the cycle limit or in a trap.
        inputs: with inputs.
        pictures: each frame sends to all outputs, which may be pictures.
    """

    statements: int
    work: int
    passes: int
    plain: bool = False
    wild: bool = False
    inputs: bool = False
    pictures: bool = False


def draw_case(
    random: Random,
    isa: Isa | None = None,
    more: More | None = None,
    *,
    plain: bool = False,
    large: bool = False,
) -> Case:
    """A random case: most are small, because each program is another shape.

    Args:
        random: draws it.
        isa: instruction set, if it is not the built-in one.
        more: draws an instruction of that set, given a function that draws a register.
        plain: only programs that always end, whose loops count down, and that ask no partner.
        large: only arrays beyond a vector or two, of up to 5,000 NPs, and short programs.
    """
    size = random.randrange(200)
    large = large or (not plain and size == 199)
    pictures = not plain and size >= 6 and random.randrange(3 if large else 12) == 0
    wild = not plain and not pictures and random.randrange(12) == 0
    inputs = not plain and random.randrange(10) == 0
    if pictures:
        style = Style(random.randrange(4), 60, 6, inputs=inputs, pictures=True)
    elif large:
        style = Style(random.randrange(4, 16), 60, 6, plain, wild, inputs)
    elif size < 4:
        style = Style(90, 1500, 60, plain, wild, inputs)
    elif size < 6:
        style = Style(20, 20_000, 2_000, plain, wild, inputs)
    else:
        style = Style(random.randrange(4, 26), 120, 10, plain, wild, inputs)
    machine = draw_machine(random, "large" if large else "small" if 2 <= size < 196 else "medium")
    short = random.randrange(1, random.choice([1500, 100 * machine.np_rows]))
    if pictures:
        frames, rings = [3, 4, 5] if large else [3, 5, 9, 20], [0, 0, 0, 1, 3, 4]
    else:
        frames, rings = (
            [0, 1, 2, 2, 3, 4] if large or size < 6 else [0, 1, 1, 2, 2, 3],
            [0] * 9 + [1],
        )
    return Case(
        _Writer(random, machine, more, style).program(),
        machine,
        seed=random.randrange(1000),
        frames=random.choice(frames),
        limit=random.randrange(1, 2000) if wild else random.choice([NO_LIMIT] * 5 + [short]),
        again=random.randrange(10) == 0,
        states=random.choice([1, 1, 1, 2]),
        partner=random.choice(PARTNERS) if inputs else "missing",
        isa=isa,
        tight=random.randrange(4) == 0,
        ring=random.choice(rings),
        hears=random.choice([0] * 9 + [100, random.randrange(1, 6)]),
    )


class _Writer:
    def __init__(self, random: Random, machine: Machine, more: More | None, style: Style) -> None:
        self._random = random
        self._more = more
        self._style = style
        self._lines: list[str] = []
        self._labels = 0
        self._outputs: list[tuple[int, str]] = []  # ports and kinds of what each frame sends
        self._straight = style.statements < 30  # a picture may be a line for each send
        self._room = style.statements
        self._work = style.work
        self._weight = 1  # passes of the loops around
        self._noisy = machine.sensor.noise_rms or machine.sensor.fixed_pattern
        self._banks = range(0, machine.memory_bytes, 64)
        # Few registers and addresses, so that instructions work on each other's results.
        self._registers = [f"r{random.randrange(16 - len(COUNTERS))}" for _ in range(4)]
        self._addresses = [random.randrange(machine.memory_bytes) for _ in range(3)]
        self._turn = next(f"r{n}" for n in range(5) if f"r{n}" not in self._registers)
        self._counters: list[str] = []  # of the loops around
        self._inside: list[str] = []  # labels in the middle of loops, to jump to
        self._routines = random.randrange(3)
        # Regions open where a routine is called: the same number for all its calls.
        self._depths = [random.choice([0, 0, 1, 2]) for _ in range(self._routines)]

    def program(self) -> str:
        random = self._random
        pictures = self._style.pictures
        kinds = [
            "scalar",
            "scalar",
            "list",
            "plane",
            *(["picture"] * 4 if pictures else ["scalar16"]),
        ]
        for port in range(random.randrange(1, FREE + 1) if pictures else random.randrange(4)):
            kind = random.choice(kinds)
            if pictures:
                self._outputs.append((port, kind))
            self._emit(f".output out{port}, {port}, {kind}")
        if pictures:
            self._emit(f"MOV {self._turn}, #0")
        if random.randrange(3):
            self._block(depth=0, loops=0, routines=self._routines)
        self._emit("frame: EXPOSE")
        late = random.randrange(len(self._outputs) + 1)
        self._send(self._outputs[late:])
        self._block(depth=0, loops=0, routines=self._routines)
        self._send(self._outputs[:late])
        last = "NOP" if self._routines == 0 else "HALT"  # a NOP would run into the first routine
        often = 50 if pictures else 5
        self._emit(random.choice(["JMP frame"] * often + ["HALT", "RET", last]))
        for number in range(self._routines):
            self._emit(f"routine{number}:")
            self._room, self._work = max(self._room, 2), max(self._work, 20)
            self._block(depth=self._depths[number], loops=OWN, routines=number)
            self._emit("RET")
        return "\n".join(self._lines) + "\n"

    def _emit(self, line: str) -> None:
        self._lines.append(line if ":" in line else f"    {line}")

    def _label(self) -> str:
        self._labels += 1
        return f"l{self._labels}"

    def _block(self, *, depth: int, loops: int, routines: int) -> None:
        for _ in range(self._random.randrange(1, 5 + self._style.statements // 10)):
            if self._room <= 0 or self._work <= 0:
                return
            self._room -= 1
            self._work -= self._weight
            self._statement(depth=depth, loops=loops, routines=routines)

    def _statement(self, *, depth: int, loops: int, routines: int) -> None:
        random, style = self._random, self._style
        kind = random.randrange(24)
        if kind <= 1 and depth < 4:
            self._where(depth, loops, routines)
        elif kind <= 3 and loops < (OWN if routines == self._routines else len(COUNTERS)):
            self._loop(depth, loops, routines)
        elif kind == 4:
            self._branch(depth, loops, routines)
        elif kind == 5 and loops <= OWN and depth in self._depths[:routines]:
            self._emit(f"CALL routine{self._depths.index(depth)}")
        elif kind == 6:
            port = random.randrange(FREE if self._outputs else 0, 5)
            self._emit(f"OUT {port}, {self._source()}")
        elif kind == 7 and random.randrange(2 if self._noisy else 3) == 0:  # long to compile
            self._conversions()
        elif kind == 8 and self._takes_frames(depth, loops):
            self._emit("EXPOSE")
        elif kind == 9:
            self._same_address()
        elif kind <= 11 and style.inputs:
            self._emit(f"IN {self._register()}, {random.randrange(3)}")
        elif kind == 12 and style.wild:
            self._wild(depth, routines)
        else:
            self._emit(self._simple())

    def _send(self, outputs: Sequence[tuple[int, str]]) -> None:
        """Send to some outputs, mostly what suits their kinds."""
        random = self._random
        for port, kind in outputs:
            register = self._register()
            if kind == "picture":
                self._picture(port)
            elif kind == "plane":
                for _ in range(random.choice([1, 1, 2])):
                    self._emit(random.choice([f"LD {register}, {self._address()}", self._simple()]))
                    self._emit(f"OUT {port}, {register}")
            else:
                self._emit(f"MOV {register}, #{random.randrange(256)}")
                for _ in range(random.choice([1, 1, 3])):
                    self._emit(f"OUT {port}, {register}")

    def _picture(self, port: int) -> None:
        random = self._random
        straight = self._straight and random.randrange(3) == 0
        self._straight = self._straight and not straight
        bank = random.choice(list(self._banks))
        value = self._register()
        names = Names(port, self._label(), *COUNTERS[:2], value, self._turn, bank)
        if random.randrange(3):
            self._emit(f"SAMPLE {random.choice(['signal', 'signal', 'reset'])}, {bank}")
        other = random.choice([FREE, FREE, FREE, self._outputs[-1][0]])
        for line in draw_picture(random, names, straight=straight, other=other):
            self._emit(line)

    def _takes_frames(self, depth: int, loops: int) -> bool:
        most = 3 if depth == loops == 0 else 0 if self._style.plain else 6
        return most > 0 and self._random.randrange(most) == 0

    def _where(self, depth: int, loops: int, routines: int) -> None:
        self._emit(f"WHERE {self._random.choice(CONDITIONS)}")
        self._block(depth=depth + 1, loops=loops, routines=routines)
        for _ in range(self._random.randrange(3)):
            self._emit("ELSE")
            self._block(depth=depth + 1, loops=loops, routines=routines)
        self._emit("END")

    def _branch(self, depth: int, loops: int, routines: int) -> None:
        random, label = self._random, self._label()
        if self._style.wild and self._inside and depth == 0 and random.randrange(3) == 0:
            label = random.choice(self._inside)
            self._emit(f"{random.choice(['JANY', 'JNONE'])} {random.choice(CONDITIONS)}, {label}")
            return
        self._emit(f"{random.choice(['JANY', 'JNONE'])} {random.choice(CONDITIONS)}, {label}")
        if random.randrange(2):
            for _ in range(random.randrange(1, 6)):  # a few become conditions on instructions
                self._emit(self._simple())
        else:
            self._block(depth=depth, loops=loops, routines=routines)
        self._emit(f"{label}:")

    def _loop(self, depth: int, loops: int, routines: int) -> None:
        random, style = self._random, self._style
        most = max(1, style.passes // self._weight)
        loop = (
            plain_loop(random, most) if style.plain else draw_loop(random, most, masked=depth > 0)
        )
        label, counter = self._label(), COUNTERS[loops]
        if style.wild and random.randrange(2):
            counter = self._register()

        def emit(lines: Sequence[str]) -> None:
            for line in lines:
                self._emit(line.format(c=counter, l=label))

        emit(loop.before)
        self._emit(f"{label}: ; {loop.kind}")
        emit(loop.first)
        self._counters.append(counter)
        self._weight *= loop.passes
        self._block(depth=depth, loops=loops + 1, routines=routines)
        early = not style.plain and random.randrange(6) == 0
        if early:
            self._emit(f"JANY {random.choice(CONDITIONS)}, {label}_end")
        if style.wild and depth == 0 and not routines < self._routines:
            self._inside.append(f"{label}_in")
            self._emit(f"{label}_in:")
        self._weight //= loop.passes
        self._counters.pop()
        emit(loop.step)
        if not style.plain and random.randrange(4) == 0:
            self._emit(self._quiet())
        emit([loop.back])
        if early or loop.first:
            self._emit(f"{label}_end:")

    def _wild(self, depth: int, routines: int) -> None:
        random = self._random
        label = self._label()
        self._emit(f"JANY {random.choice(CONDITIONS)}, {label}")
        if routines < self._routines and self._depths[routines] == depth:
            self._emit(f"CALL routine{routines}")  # itself
        else:
            self._emit(random.choice([".word 0xFFFF", "HALT"]))
        self._emit(f"{label}:")

    # ---- straight instructions

    def _register(self) -> str:
        return self._random.choice(self._registers)

    def _source(self) -> str:
        """A register to read: sometimes the counter of a loop around."""
        if self._counters and self._random.randrange(4) == 0:
            return self._random.choice(self._counters)
        return self._register()

    def _address(self) -> str:
        random = self._random
        if random.randrange(2):
            return f"[{random.choice(self._addresses)}]"
        return f"[{self._source()} + {random.choice(list(self._banks))}]"

    def _conversions(self) -> None:
        """Conversions into a bank, loads from it and stores to it."""
        random = self._random
        bank, place = random.choice(list(self._banks)), self._register()
        for _ in range(random.randrange(1, 8)):
            register, byte = self._register(), random.choice([0, 1, 63])
            name = random.choice(
                [f"[{bank + byte}]", f"[{random.choice([place, self._source()])} + {bank}]"]
            )
            lines = [
                *[f"SAMPLE reset, {bank}"] * 3,
                f"SAMPLE signal, {bank}",
                *[f"LD {register}, {name}"] * 4,
                *[f"ST {name}, {register}"] * 2,
                f"MOV {register}, #0",
                f"COL {place}",
            ]
            self._emit(random.choice(lines))

    def _same_address(self) -> None:
        """Bytes that are stored and loaded under several names."""
        random = self._random
        register, bank = self._register(), random.choice(list(self._banks))
        address = random.choice(self._addresses)
        if random.randrange(2):
            self._emit(f"MOV {register}, #{(address - bank) & 255}")
        names = [f"[{address}]", f"[{register} + {bank}]", self._address()]
        for _ in range(random.randrange(2, 5)):
            name = random.choice(names)
            lines = [f"LD {self._register()}, {name}", f"ST {name}, {self._source()}"]
            self._emit(random.choice(lines))

    def _quiet(self) -> str:
        """An instruction that leaves the flags and all counters alone."""
        rd, rs = self._register(), self._source()
        address = self._address()
        return self._random.choice(
            [f"MOV {rd}, {rs}", f"LD {rd}, {address}", f"ST {address}, {rs}", f"COL {rd}"]
        )

    def _simple(self) -> str:
        random = self._random
        if self._more is not None and random.randrange(2):
            return self._more(random, self._register)
        rd, rs = self._register(), self._source()
        numbers = [0, 0, 1, 127, 128, 255, random.randrange(256), random.choice(self._addresses)]
        number = random.choice(numbers)
        operation = random.choice(["ADD", "ADC", "SUB", "SBC", "CMP", "AND", "OR"])
        return random.choice(
            [
                f"MOV {rd}, {rs}",
                f"MOV {rd}, #{number}",
                f"MOV {rd}, #{number}",
                *[f"{operation} {rd}, {rs}"] * 6,
                *[f"{operation} {rd}, {rd}"] * 2,
                *[f"{operation} {rd}, #{number}"] * 4,
                f"SHL {rd}, #{random.randrange(1, 8)}",
                f"SHR {rd}, #{random.randrange(1, 8)}",
                f"RCR {rd}",
                f"NBR {rd}, {rs}, {random.choice(['north', 'east', 'south', 'west'])}",
                f"ROW {rd}",
                f"COL {rd}",
                *[f"LD {rd}, {self._address()}"] * 2,
                *[f"ST {self._address()}, {rs}"] * 2,
            ]
        )
