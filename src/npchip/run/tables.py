"""A result as tables of other libraries, which the extra ``sweep`` installs."""

from __future__ import annotations

import io
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from npchip.base.errors import InputError
from npchip.base.files import write_bytes

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from npchip.run.result import RunResult


def to_dataframe(result: RunResult) -> pd.DataFrame:
    """See `RunResult.to_dataframe`."""
    pandas = _library("pandas", "to_dataframe")
    columns = {"cycles": result.frame_cycles, "instructions": result.frame_instructions}
    columns |= {name: item for name, item in result.outputs.items() if _is_scalar(item)}
    made = {
        name: pandas.array(np.ma.asarray(item).filled(0).astype(np.int64), dtype="Int64")
        for name, item in columns.items()
    }
    for name, item in columns.items():
        made[name][np.ma.getmaskarray(item)] = pandas.NA
    return pandas.DataFrame(made, index=pandas.RangeIndex(*_span(result), name="frame"))


def to_xarray(result: RunResult) -> xr.Dataset:
    """See `RunResult.to_xarray`."""
    xarray = _library("xarray", "to_xarray")
    scalars = {"cycles": result.frame_cycles, "instructions": result.frame_instructions}
    found: dict[str, Any] = {name: ("frame", item) for name, item in scalars.items()}
    coordinates: dict[str, Any] = {"frame": np.arange(*_span(result))}
    for name, item in result.outputs.items():
        dimensions: tuple[str, ...] = ("frame",)
        if isinstance(item, list):
            continue  # of different lengths
        if item.ndim == 3:
            plane = item.shape[1:] == result.geometry
            dimensions = ("frame", *(("np_row", "np_col") if plane else ("row", "col")))
            for side, length in zip(dimensions[1:], item.shape[1:], strict=True):
                coordinates[side] = np.arange(length)
        missing = np.ma.getmaskarray(item).any()
        found[name] = dimensions, np.ma.filled(item.astype(float), np.nan) if missing else item
    about = {"program": result.program, "machine": result.machine, "status": result.status}
    return xarray.Dataset(found, coordinates, about)  # type: ignore[no-any-return]


def to_parquet(result: RunResult, path: str | Path) -> None:
    """See `RunResult.to_parquet`."""
    _library("pyarrow", "to_parquet")
    buffer = io.BytesIO()
    to_dataframe(result).to_parquet(buffer)
    write_bytes(Path(path), buffer.getvalue())


def _is_scalar(item: Any) -> bool:
    return not isinstance(item, list) and item.ndim == 1


def _span(result: RunResult) -> tuple[int, int]:
    return result.first_frame, result.first_frame + result.frames


def _library(name: str, what: str) -> Any:
    """Import a library.

    Raises:
        InputError: NP640 it is not installed.
    """
    try:
        return import_module(name)
    except ModuleNotFoundError:
        hint = "pip install 'npchip[sweep]' installs it"
        raise InputError("NP640", f"{what} needs {name}", hint=hint) from None
