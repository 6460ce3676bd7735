"""Files of trained networks: JSON of a kind and a schema, whose numbers make sense."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.base.files import read_bytes

_T = TypeVar("_T")

KIND: Final = "npchip-orientation"
_MOST_BYTES: Final = 1 << 24

LARGEST: Final = 1e9
"""Largest number in a network."""


def read_document(
    path: Path, kind: str, schemas: tuple[int, ...], make: Callable[[dict[str, Any]], _T]
) -> _T:
    """Read a JSON file of a kind and one of its schemas, the newest last; make an object of it.

    Raises:
        InputError: NP456, it is not such a file, or damaged.
    """
    hint = "npchip orient train writes such files"
    try:
        document = json.loads(read_bytes(path, _MOST_BYTES))
    except OSError as error:
        raise InputError("NP456", f"cannot read {path}: {error.strerror or error}") from None
    except (ValueError, RecursionError):
        raise InputError("NP456", f"{path}: not a JSON file", hint=hint) from None
    if not isinstance(document, dict) or document.get("kind") != kind:
        found = document.get("kind") if isinstance(document, dict) else None
        if found == f"{KIND}-8bit":
            hint = "that network is for the array: npchip run orientation"
        raise InputError(
            "NP456", f"{path}: expected a file of kind {kind}, found {found}", hint=hint
        )
    if document.get("schema") not in schemas:
        raise InputError(
            "NP456",
            f"{path}: expected schema {schemas[-1]}, found {document.get('schema')}",
            hint="train it anew with this version",
        )
    try:
        return make(document)
    except (KeyError, TypeError, ValueError, IndexError, OverflowError) as error:
        why = f"{error} is missing" if isinstance(error, KeyError) else error
        raise InputError("NP456", f"{path}: damaged: {why}", hint=hint) from None


def numbers(document: dict[str, Any], name: str, *, whole: bool = False) -> NDArray[Any]:
    """Return an entry of a file as an array of float64, or of int64 for whole numbers.

    Raises:
        KeyError: there is no such entry.
        ValueError: it holds something else, or numbers that no network has.
    """
    values = np.array(document[name])
    if values.size == 0 or values.dtype.kind not in ("iu" if whole else "iuf"):
        raise ValueError(f"{name}: expected {'whole ' if whole else ''}numbers")
    wrong = values[~(abs(values.astype(np.float64)) <= LARGEST)]  # of NaN too
    if wrong.size:
        raise ValueError(f"{name}: expected numbers up to {LARGEST:g}, found {wrong[0]}")
    return values.astype(np.int64 if whole else np.float64)
