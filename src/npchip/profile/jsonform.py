"""A profile as JSON (schema 1)."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from npchip.base.json import in_rows
from npchip.report.jsonform import head

if TYPE_CHECKING:
    from npchip.profile.model import Call, Profile, Word

SCHEMA = 1


def to_text(profile: Profile) -> str:
    """Return a profile as strict JSON, with a line for each key, word, label and branch."""
    return in_rows(to_document(profile), ("labels", "words", "branches"), margin="  ")


def to_document(profile: Profile) -> dict[str, Any]:
    """Return a profile as plain dicts, lists, strings, numbers and None."""
    frames = profile.frames
    return head(profile.result, SCHEMA) | {
        "cycles": profile.cycles,
        "setup_cycles": profile.result.setup.cycles,
        "cycles_per_frame": None
        if frames is None
        else {
            "frames": frames.count,
            "minimum": frames.least,
            "minimum_frame": frames.least_at,
            "median": frames.median,
            "maximum": frames.most,
            "maximum_frame": frames.most_at,
        },
        "calls": _call(profile.calls),
        "labels": [asdict(label) for label in profile.labels],
        "words": [_word(word) for word in profile.words],
        "branches": [asdict(branch) for branch in profile.branches],
    }


def _call(call: Call) -> dict[str, Any]:
    return {
        "name": call.name,
        "address": call.address,
        "calls": call.calls,
        "own_cycles": call.own,
        "cycles": call.total,
        "children": [_call(child) for child in call.children],
    }


def _word(word: Word) -> dict[str, Any]:
    place = word.place
    return {
        "address": word.address,
        "file": place.file if place else None,
        "line": place.line if place else None,
        "executions": word.executions,
        "cycles": word.cycles,
        "active": word.active,
    }
