"""A result as a table of pandas, as a data set of xarray and as Parquet."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.base.errors import InputError
from npchip.run.result import RunResult
from tests.support.results import made

SOURCE = """
.output number, 0, scalar
.output many, 1, list
.output where, 2, plane
.output bright, 3, picture
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     r0, #7
        OUT     0, r0
        OUT     1, r0
        ROW     r1
        OUT     2, r1
        MOV     r2, #0
.next:  LD      r3, [r2 + 0]
        OUT     3, r3
        ADD     r2, #1
        CMP     r2, #64
        JANY    NE, .next
        JMP     frame
"""


@pytest.fixture(scope="module")
def result() -> RunResult:
    clip = np.random.default_rng(1).integers(0, 256, (3, 64, 80), np.uint8)
    return Chip(assemble_text(SOURCE)).run(clip)


def test_a_frame_is_a_row(result: RunResult) -> None:
    pytest.importorskip("pandas")
    table = result.to_dataframe()
    assert [*table.columns] == ["cycles", "instructions", "number"]
    assert table.index.name == "frame"
    assert table["number"].tolist() == [7, 7, 7]
    assert table["cycles"].tolist() == result.frame_cycles.tolist()


def test_nothing_sent_is_not_zero() -> None:
    pandas = pytest.importorskip("pandas")
    sent = np.ma.array(np.array([1, 2, 0], np.int32), mask=[False, False, True])
    found = made({"x": sent}, [1, 2, 3], first_frame=5)
    table = found.to_dataframe()
    assert table.index.tolist() == [5, 6, 7]
    assert table["x"].tolist()[:2] == [1, 2]
    assert table["x"].isna().tolist() == [False, False, True]
    assert pandas.isna(table["x"].iloc[2])
    pytest.importorskip("xarray")
    assert np.isnan(found.to_xarray()["x"].to_numpy()[2])


def test_planes_and_pictures_have_their_coordinates(result: RunResult) -> None:
    pytest.importorskip("xarray")
    found = result.to_xarray()
    assert found["where"].dims == ("frame", "np_row", "np_col")
    assert found["bright"].dims == ("frame", "row", "col")
    assert int(found["where"].sel(frame=1, np_row=6, np_col=3)) == 6
    assert int(found["bright"].sel(frame=2, row=63, col=11)) == result.outputs["bright"][2, 63, 11]
    assert "many" not in found
    assert found.attrs == {"program": "program", "machine": "default", "status": result.status}


def test_parquet_holds_the_same(result: RunResult, tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    file = tmp_path / "frames.parquet"
    result.to_parquet(file)
    pandas.testing.assert_frame_equal(pandas.read_parquet(file), result.to_dataframe())
    with pytest.raises(InputError, match="NP250"):
        result.to_parquet(tmp_path / "nowhere" / "frames.parquet")


@pytest.mark.parametrize(
    ("method", "library"), [("to_dataframe", "pandas"), ("to_xarray", "xarray")]
)
def test_without_the_library_the_error_says_what_to_install(
    result: RunResult, monkeypatch: pytest.MonkeyPatch, method: str, library: str
) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(InputError, match=rf"{method} needs {library} \[NP640\]\n.*npchip\[sweep\]"):
        getattr(result, method)()
