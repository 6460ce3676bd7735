"""Threads: a chip for each works, one chip for several is refused."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from threading import Event
from typing import Any

import numpy as np
import pytest

from npchip import Chip, InputError, assemble_text

PROGRAM = """\
.output value, 0, scalar
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      r0, [0]
        OUT     0, r0
        JMP     frame
"""


@pytest.mark.parametrize("engine", ["wasm", "reference"])
def test_a_chip_is_not_entered_by_two_threads(engine: Any) -> None:
    """Fails before: results were wrong without a word."""
    chip = Chip(assemble_text(PROGRAM), engine=engine)
    inside, done = Event(), Event()

    def wait(_frame: object) -> None:
        inside.set()
        assert chip.snapshot()  # the same thread may look
        assert done.wait(30)

    with ThreadPoolExecutor(1) as pool:
        run = pool.submit(chip.run, np.ones((1, 64, 80), np.uint8), on_frame=wait)
        assert inside.wait(30)
        try:
            for enter in (chip.run, chip.step, chip.reset, chip.snapshot):
                with pytest.raises(InputError, match="another thread") as caught:
                    enter()
                assert caught.value.code == "NP107"
        finally:
            done.set()
        assert run.result().outputs["value"].tolist() == [1]
    assert chip.run(np.full((1, 64, 80), 2, np.uint8)).outputs["value"].tolist() == [2]


def test_each_thread_has_its_chip() -> None:
    program = assemble_text(PROGRAM)

    def run(value: int) -> list[int]:
        frames = np.full((20, 64, 80), value, np.uint8)
        return Chip(program).run(frames).outputs["value"].tolist()  # type: ignore[no-any-return]

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(run, range(8))) == [[value] * 20 for value in range(8)]
