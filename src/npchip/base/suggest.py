"""The word that a misspelt one may stand for."""

from __future__ import annotations

from collections.abc import Iterable


def near_miss(word: str, known: Iterable[str]) -> str | None:
    """The known word that `word` is nearest to; None where none is near."""
    from difflib import get_close_matches  # noqa: PLC0415 - few runs meet a misspelt word

    return next(iter(get_close_matches(word, list(known), n=1)), None)
