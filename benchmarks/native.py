"""The native limit: `native.c` compiled for this machine."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

OUTPUTS = ("valid", "center_row", "center_col", "predicted_row", "predicted_col")
FLAGS = ("-O3", "-march=native", "-shared", "-fPIC", "-Wno-psabi")


class Native:
    """The C version of ``asm/trajectory.s``."""

    def __init__(self) -> None:
        compiler = shutil.which("gcc")
        if compiler is None:
            raise RuntimeError("gcc is not installed")
        source = Path(__file__).with_name("native.c")
        with tempfile.TemporaryDirectory() as directory:
            library = Path(directory) / "native.so"
            subprocess.run([compiler, *FLAGS, str(source), "-o", str(library)], check=True)
            self._trajectory = ctypes.CDLL(str(library)).trajectory
        self._trajectory.restype = None
        self._trajectory.argtypes = [
            ctypes.c_void_p,
            ctypes.c_long,
            ctypes.c_int,
            ctypes.c_void_p,
        ]

    def trajectory(self, frames: NDArray[np.uint8], threshold: int = 32) -> NDArray[np.uint8]:
        """Outputs of every frame: uint8, shape (T, 5), in the order of `OUTPUTS`.

        Args:
            frames: uint8, shape (T, 64, 80), contiguous.
            threshold: as in the program; up to 128.
        """
        results = np.empty((len(frames), len(OUTPUTS)), np.uint8)
        self._trajectory(frames.ctypes.data, len(frames), threshold, results.ctypes.data)
        return results
