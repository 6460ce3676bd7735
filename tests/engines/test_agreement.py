"""`python -m tests.agreement`: it finds a planted mistake, makes it small, and goes on."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random

import pytest
from click.testing import CliRunner

from npchip.engines.wasm.emit.effects import Effects
from npchip.engines.wasm.translate.builder import ValueBuilder
from npchip.engines.wasm.translate.memory import Memory
from npchip.engines.wasm.translate.summary import Item
from npchip.engines.wasm.translate.values import Value
from tests.agreement.__main__ import main
from tests.agreement.share import run_share
from tests.agreement.shrink import shrink
from tests.support.chips import machine_of
from tests.support.lockstep import first_divergence
from tests.support.random_cases import Case
from tests.support.random_programs import draw_case


@pytest.mark.long
def test_a_planted_mistake_is_found_and_made_small(monkeypatch: pytest.MonkeyPatch) -> None:
    def forgetful(self: Memory, address: Value, value: Value, _mask: Value | None) -> None:
        self._bytes[address] = value  # other names of this byte still have the old value

    monkeypatch.setattr(Memory, "store", forgetful)
    share = run_share(range(400))
    assert share.failures
    smallest = min(share.failures, key=lambda failure: failure["lines"][1])
    assert smallest["lines"][1] <= 8
    assert "first divergence in run" in "".join(smallest["failure"])


def test_the_instruction_behind_which_the_engines_differ_is_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    source = "COL r1\nROW r2\nMOV r3, #7\nOR r1, r2\nADD r1, r3\nHALT"
    case = Case(source, machine_of(), seed=1, frames=0, limit=100, again=False)
    assert first_divergence(case) == "in run 0, side by side, the engines agree"
    monkeypatch.setattr(ValueBuilder, "or_", lambda _self, a, _b: a)
    assert first_divergence(case).startswith(
        "first divergence in run 0 (step by step): after address 3 (OR r1, r2): "
    )


@pytest.mark.long
def test_an_engine_that_raises_is_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Memory, "forget", lambda _: 1 // 0)
    share = run_share(range(40))
    assert share.failures
    assert "ZeroDivisionError" in share.failures[0]["failure"][-1]
    assert any("SAMPLE" in line for line in share.failures[0]["program"])


@pytest.mark.long
def test_a_wrong_count_is_found_on_request(monkeypatch: pytest.MonkeyPatch) -> None:
    original = Effects._count  # noqa: SLF001

    def forgetful(self: Effects, item: Item) -> None:
        if item.number == 0:  # not what a region lets in
            original(self, item)

    monkeypatch.setattr(Effects, "_count", forgetful)
    assert not run_share(range(40)).failures
    share = run_share(range(40), profile=True)
    assert share.failures
    assert share.failures[0]["failure"][0].startswith("NPs that enter at address ")


def test_shrinking_removes_regions_and_loops() -> None:
    def fails(case: Case) -> bool:
        depth = 0
        for line in case.text.split():
            depth += {"WHERE": 1, "END": -1}.get(line, 0)
            if depth < 0:
                return False
        return depth == 0 and "NBR" in case.text

    case = next(
        case
        for case in (draw_case(Random(seed)) for seed in range(200))
        if "NBR" in case.text and "WHERE" in case.text and case.frames > 1
    )
    small = shrink(case, fails)
    assert small.text.count("\n") == 1
    assert small.frames == 0


def test_a_seed_is_a_case() -> None:
    assert draw_case(Random(5)) == draw_case(Random(5))
    assert draw_case(Random(5)) != draw_case(Random(6))


@pytest.mark.long
def test_the_command_writes_what_it_covered_and_goes_on(tmp_path: Path) -> None:
    path = tmp_path / "sub" / "agreement.json"
    words = ["--seed", "7", "--summary", str(path)]
    result = CliRunner().invoke(main, ["--programs", "20", *words])
    assert result.exit_code == 0, result.output
    assert "20 programs, 0 divergences" in result.output
    told = json.loads(path.read_text("utf-8"))
    assert (told["first"], told["next"], told["programs"]) == (7, 27, 20)
    result = CliRunner().invoke(main, ["--programs", "30", "--resume", *words])
    assert result.exit_code == 0, result.output
    told = json.loads(path.read_text("utf-8"))
    assert (told["first"], told["next"], told["programs"]) == (7, 37, 30)
    assert told["features"]["masks"] > 10


@pytest.mark.long
def test_all_arrays_are_large_on_request(tmp_path: Path) -> None:
    path = tmp_path / "agreement.json"
    words = ["--seed", "30", "--summary", str(path)]
    assert CliRunner().invoke(main, ["--programs", "8", "--large", *words]).exit_code == 0
    CliRunner().invoke(main, ["--programs", "16", "--resume", *words])
    told = json.loads(path.read_text("utf-8"))
    sizes = [
        told["features"][f"large arrays: {size} 16 vectors"] for size in ("up to", "more than")
    ]
    assert sum(sizes) == told["programs"] == 16
    assert min(sizes) > 0


@pytest.mark.long
def test_a_million_would_cover_everything() -> None:
    """Rare features appear within some hundred programs."""
    features = run_share(range(2_000, 2_400)).features
    wanted = {
        *(
            "calls",
            "nested masks",
            "nested loops",
            "inputs",
            "noise",
            "neighbours",
            "WHERE in a loop",
        ),
        *("ends: NP302", "ends: NP303", "ends: NP305", "ends: NP306", "ends: cycle-limit"),
        *("partner: sends", "partner: stops", "partner: missing", "several states"),
        *("loop bit to the left", "loop bit to the right", "loop counts up", "loop tests first"),
        *("noise and fixed pattern", "pictures in all frames", "pictures in some frames"),
        *("pictures at several ports", "large arrays: more than 1,000 NPs", "a listener"),
        *("little room for frames and sends",),
        *("vectors: 1", "vectors: 2", "vectors: more", "more than 60 lines", "IN in a loop"),
    }
    assert not wanted - set(features)
