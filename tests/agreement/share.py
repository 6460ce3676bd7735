"""Some seeds in one process: cases drawn, run on both engines, failures shrunk."""

from __future__ import annotations

import resource
import traceback
from collections import Counter
from contextlib import AbstractContextManager
from dataclasses import asdict, dataclass, field, replace
from random import Random
from typing import Any

from npchip.assembler import AssemblyError
from npchip.base.errors import InputError
from tests.agreement.features import features
from tests.agreement.shrink import shrink
from tests.support.lockstep import DivergenceError, assert_engines_agree
from tests.support.patience import at_most
from tests.support.random_cases import Case
from tests.support.random_programs import draw_case

PATIENCE = 60
"""Seconds of processor time for one program; one that takes longer is a failure."""


@dataclass
class Share:
    """Results of some seeds.

    Attributes:
        programs: how many there were.
        runs: how often they ran; a program may begin in several states.
        features: how many programs have what.
        failures: each with its seed, what is wrong and a small program.
        memory: largest size of the process so far, in MiB.
    """

    programs: int = 0
    runs: int = 0
    features: Counter[str] = field(default_factory=Counter)
    failures: list[dict[str, Any]] = field(default_factory=list)
    memory: int = 0


class _PatienceError(Exception):
    """A program takes too long."""


def run_share(seeds: range, *, profile: bool = False, large: bool = False) -> Share:
    """Draw and run a case for each seed; with a `profile`, or on `large` arrays, on request."""
    share = Share()
    for seed in seeds:
        case = replace(draw_case(Random(seed), large=large), profile=profile)
        share.programs += 1
        try:
            with _patience():
                results = assert_engines_agree(case)
        except Exception as error:  # noqa: BLE001 - whatever an engine raises is its failure
            share.failures.append(_failure(seed, case, error))
        else:
            share.runs += len(results)
            share.features.update(features(case, results))
    share.memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> 10
    return share


def _patience() -> AbstractContextManager[None]:
    return at_most(PATIENCE, _PatienceError(f"more than {PATIENCE} seconds"), by="processor")


def _failure(seed: int, case: Case, error: Exception) -> dict[str, Any]:
    def fails(other: Case) -> bool:
        try:
            other.program()
        except (AssemblyError, InputError):
            return False
        try:
            with _patience():
                assert_engines_agree(other)
        except Exception as raised:  # noqa: BLE001 - see above
            return type(raised) is type(error)
        return False

    small = case if isinstance(error, _PatienceError) else shrink(case, fails)
    return {
        "seed": seed,
        "failure": _told(small, error),
        "program": small.text.splitlines(),
        "case": {
            "seed": small.seed,
            "frames": small.frames,
            "limit": small.limit,
            "again": small.again,
            "states": small.states,
            "partner": small.partner,
            "tight": small.tight,
            "ring": small.ring,
            "hears": small.hears,
            "geometry": small.machine.geometry,
            "memory_bytes": small.machine.memory_bytes,
            "sensor": asdict(small.machine.sensor),
            "cycles": dict(small.machine.timing),
        },
        "lines": [case.text.count("\n"), small.text.count("\n")],
    }


def _told(case: Case, first: Exception) -> list[str]:
    """Return what is wrong with the small program, without its text."""
    try:
        with _patience():
            assert_engines_agree(case)
    except DivergenceError as error:
        return str(error).removesuffix(case.text).strip().splitlines()
    except Exception as error:  # noqa: BLE001 - see above
        return "".join(traceback.format_exception(error)).splitlines()
    return [f"only before it was made smaller: {first}"]
