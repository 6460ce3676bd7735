"""Random ways to send a picture: in and out of order, among other sends, in some frames only."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

PIXELS = 64


@dataclass(frozen=True)
class Names:
    """Names that the lines of a picture may use.

    Attributes:
        port: where the picture goes.
        label: begins the labels.
        counter: register that counts the sends.
        place: register with the pixel.
        value: register that is sent.
        turn: register that counts the frames, and nobody else uses.
        bank: first byte of the bank with the pixels.
    """

    port: int
    label: str
    counter: str
    place: str
    value: str
    turn: str
    bank: int


def draw_picture(random: Random, names: Names, *, straight: bool, other: int) -> list[str]:
    """Lines that send a picture, most of them in the same way in each frame.

    Args:
        random: draws them.
        names: registers, ports and labels.
        straight: as a line for each send, rather than as a loop.
        other: another port, to which something may be sent in between.
    """
    n = names
    step, first = random.choice([(1, 0), (1, 0), (1, 0), (63, 63), (8, 0), (37, 5)])
    sends = random.choice([PIXELS] * 20 + [PIXELS - 1, PIXELS + 1, 2 * PIXELS])
    body = random.choice(
        [
            *[[f"OUT {n.port}, {n.value}"]] * 5,
            [f"OUT {n.port}, {n.value}", f"OUT {other}, {n.value}"],
            [f"OUT {other}, {n.counter}", f"OUT {n.port}, {n.value}"],
            [f"CMP {n.value}, #99", "WHERE LO", f"OUT {n.port}, {n.value}", "END"],
            [f"OUT {n.port}, {n.value}", f"ADD {n.value}, #1", f"OUT {n.port}, {n.value}"],
        ]
    )
    if len(body) == 3:
        sends //= 2
    if straight and sends * (1 + len(body)) <= 200:  # of 512 words
        pixel = f"(i * {step} + {first} & 63) + {n.bank}"
        lines = [f".rept {sends}, i", f"LD {n.value}, [{pixel}]", *body, ".endr"]
    else:
        parts = random.choice([1] * 7 + [2])
        lines = _loop(names, f"{n.label}_sends", body, first, step=step, sends=sends // parts)
        if parts == 2:
            lines.append(f"OUT {other}, {n.value}")
            middle = first + step * (sends // 2) & 63
            lines += _loop(names, f"{n.label}_rest", body, middle, step=step, sends=sends // 2)
    every = random.choice([1] * 6 + [2, 2, 3])
    if every == 1:
        return lines
    skip, done = f"{n.label}_skipped", f"{n.label}_done"
    lines = [
        f"ADD {n.turn}, #{256 // every}",
        f"JANY {random.choice(['LO', 'HS'])}, {skip}",
        *lines,
    ]
    if random.randrange(2):
        return [*lines, f"{skip}:"]
    # In the other frames as many sends, but not the same.
    turned = [line.replace(f"OUT {n.port}", f"OUT {other}") for line in body]
    instead = random.choice([body[::-1] if len(body) == 2 else body, turned])
    again = _loop(names, f"{n.label}_again", instead, 63 - first, step=64 - step, sends=sends)
    return [*lines, f"JMP {done}", f"{skip}:", *again, f"{done}:"]


def _loop(
    names: Names, label: str, body: list[str], first: int, *, step: int, sends: int
) -> list[str]:
    return [
        f"MOV {names.counter}, #{sends}",
        f"MOV {names.place}, #{first}",
        f"{label}:",
        f"LD {names.value}, [{names.place} + {names.bank}]",
        *body,
        f"ADD {names.place}, #{step}",
        f"AND {names.place}, #63",
        f"SUB {names.counter}, #1",
        f"JANY NE, {label}",
    ]
