"""Files with bytes for the NPs' memory (``--memory``, ``memory=``)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.machine import Machine


def read_memory(address: int, path: Path, machine: Machine) -> NDArray[np.uint8]:
    """Read bytes for the NPs' memory from `address` on.

    Returns:
        uint8, shape (n, NP rows, NP columns).

    Raises:
        InputError: NP243, the file cannot be read, or its shape, type or values do not fit.
    """
    space = machine.memory_bytes - address
    try:
        array = np.load(path, allow_pickle=False)
    except OSError as error:
        raise InputError("NP243", f"cannot read {path}: {error.strerror or error}") from None
    except (ValueError, EOFError):
        raise InputError("NP243", f"{path}: not a NumPy array file (.npy)") from None
    if not isinstance(array, np.ndarray):
        raise InputError("NP243", f"{path}: an archive of arrays (.npz), expected one .npy array")
    if (
        array.ndim != 3
        or array.shape[1:] != (machine.np_rows, machine.np_cols)
        or len(array) > space
    ):
        raise InputError(
            "NP243",
            f"{path}: the array's shape is {array.shape}, expected"
            f" (n, {machine.np_rows}, {machine.np_cols}) with n up to {max(space, 0)},"
            f" as NP memory has {machine.memory_bytes} bytes and the first goes to {address}",
        )
    if array.dtype.kind not in "ui" or (array.size and not 0 <= array.min() <= array.max() <= 255):
        raise InputError(
            "NP243",
            f"{path}: values are {array.dtype}, expected whole numbers from 0 to 255",
            hint="convert with array.clip(0, 255).round().astype('uint8')",
        )
    return array.astype(np.uint8)
