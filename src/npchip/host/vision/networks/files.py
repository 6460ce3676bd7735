"""Weights as files for ``.memory`` and ``--memory``, and frames as clips."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from npchip import bundle
from npchip.base.errors import InputError
from npchip.base.files import write_bytes
from npchip.frames.memory import read_memory
from npchip.host.vision.networks.features import Frames
from npchip.host.vision.networks.network import ADDRESS, Network, from_planes
from npchip.machine import load_machine


def bundled(name: str) -> Path:
    """Return the weights that come with npchip.

    Raises:
        InputError: NP543, there are none.
    """
    top = bundle.top()
    places = [top / "asm" / f"{name}.npy", top / "examples" / "templates" / f"{name}.npy"]
    path = next((place for place in places if place.is_file()), None)
    if path is None:
        hint = f"npchip network train {name} -o {name}.npy, then --weights {name}.npy"
        raise InputError("NP543", f"no weights for {name} come with npchip", hint=hint)
    return path


def load(path: Path) -> Network:
    """Read a network that `save` wrote.

    Raises:
        InputError: NP243 the file cannot be read, NP543 it holds no network.
    """
    try:
        return from_planes(read_memory(ADDRESS, path, load_machine("default")))
    except ValueError as error:
        hint = "npchip network train writes such files"
        raise InputError("NP543", f"{path}: {error}", hint=hint) from None


def save(path: Path, network: Network) -> None:
    """Write a network for ``.memory 128`` and ``--memory 128=FILE.npy``.

    Raises:
        InputError: NP250, it cannot be written.
    """
    _write(path, network.planes())


def save_frames(path: Path, frames: Frames) -> None:
    """Write frames as a clip.

    Raises:
        InputError: NP250, it cannot be written.
    """
    _write(path, frames)


def _write(path: Path, array: NDArray[Any]) -> None:
    buffer = io.BytesIO()
    np.save(buffer, array, allow_pickle=False)
    write_bytes(path, buffer.getvalue())
