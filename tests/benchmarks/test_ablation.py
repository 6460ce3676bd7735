"""`python -m benchmarks ablation`: what it replaces, counts and prints; no figure is judged."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks import ablation
from benchmarks.__main__ import main
from benchmarks.ablation import Times, row, shown
from benchmarks.measure import interleaved
from benchmarks.parts import PARTS, Part, found
from benchmarks.programs import long_clip, made, sources
from npchip import assemble, load_machine
from tests.support.compiled import compiled

NAMES = [part.name for part in PARTS]


def times(*pairs: tuple[float, float]) -> dict[str, Times]:
    """A program for each pair: its time in steady state and until it is ready."""
    return {f"p{k}": Times([steady], [ready]) for k, (steady, ready) in enumerate(pairs)}


@pytest.mark.parametrize("part", PARTS, ids=NAMES)
def test_a_part_is_in_the_engine_and_comes_back(part: Part) -> None:
    """If this fails, a part has gone or has another name: change its entry in `PARTS`."""
    before = found(part.target)
    with part.without():
        assert found(part.target) is not before
    assert found(part.target) is before
    assert (part.lines > 0) == bool(part.serves)


def test_names_are_unique() -> None:
    assert len({*NAMES}) == len(NAMES)


@pytest.mark.long
@pytest.mark.parametrize("part", PARTS, ids=NAMES)
def test_results_are_the_same_without_a_part(part: Part) -> None:
    clip = long_clip()[:20]
    for name in ("trajectory", "orientation", "fusion_lut"):
        program = assemble(sources()[name])
        whole, other = made(program), made(program)
        expected = whole.run(clip).outputs
        with part.without():
            outputs = other.run(clip).outputs
        for output, values in expected.items():
            np.testing.assert_array_equal(outputs[output], values)
        assert other.cycles == whole.cycles


def test_a_part_is_off_only_for_a_time() -> None:
    """Without unrolling there are fewer instructions, and afterwards as many as before."""
    unrolling = next(part for part in PARTS if part.name == "unrolling")

    def instructions() -> int:
        return compiled(sources()["imaging"].read_text(), load_machine("default")).instructions

    before = instructions()
    with unrolling.without():
        assert instructions() < before
    assert instructions() == before


@pytest.mark.parametrize(
    ("pairs", "stays"),
    [
        ([(1.0, 1.0), (1.0, 1.0)], False),
        ([(1.04, 1.0), (1.04, 1.0)], True),  # all programs run longer without it
        ([(1.0, 1.04), (1.0, 1.04)], True),  # all are ready later
        ([(1.12, 1.0), (0.9, 1.0)], True),  # one program runs longer
        ([(1.0, 0.9), (1.0, 1.12)], True),  # one is ready later
        ([(1.05, 1.05), (0.97, 0.97)], False),
        ([(0.8, 0.8), (0.8, 0.8)], False),  # it does harm
    ],
)
def test_the_rule(pairs: list[tuple[float, float]], stays: bool) -> None:
    assert row(times(*pairs))["stays"] is stays


def test_the_table_names_the_worst_programs() -> None:
    found = row(times((1.25, 1.5), (0.8, 2.0)))
    assert found["speed"] == pytest.approx(1)
    assert (found["worst speed"], found["slowest"]) == (0.8, "p0")
    assert (found["worst ready"], found["latest"]) == (2.0, "p1")
    lines = shown({"some part": {"lines": 7, **found}}).splitlines()
    assert lines[1].split("  ")[0] == "some part"
    assert lines[1].split()[2:] == ["7", "1.00", "0.80", "p0", "1.73", "2.00", "p1", "stays"]


def test_a_control_that_differs_is_told() -> None:
    """No part can be judged by a run in which an unchanged engine is 5 % slower."""
    noisy = {"lines": 0, **row(times((1.05, 1.0)))}
    assert shown({ablation.CONTROL: noisy}).splitlines()[1].endswith("too noisy to judge")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["ablation", "ready"], "ablation takes neither other parts nor --page nor --against"),
        (["ablation", "--page", "x"], "ablation takes neither other parts nor --page"),
        (["ablation", "--only", "magic"], "no part 'magic'; there are uniformity"),
    ],
)
def test_what_it_refuses(
    arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert end.value.code == 2
    assert told in capsys.readouterr().err


@pytest.mark.long
def test_it_measures(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ablation, "SECONDS", 0.001)
    monkeypatch.setattr(ablation, "interleaved", lambda works: interleaved(works, 1))
    monkeypatch.setattr(ablation, "sources", lambda: {"imaging": sources()["imaging"]})
    main(["ablation", "--only", "unrolling,liveness,if-conversion", "--rounds", "1"])
    lines = capsys.readouterr().out.splitlines()
    names = ["without", "unchanged", "unrolling", "liveness", "if-conversion"]
    assert [line.split()[0] for line in lines[:5]] == names
    assert lines[4].split()[2] == "1.00"  # the module is the same: no branch is converted
