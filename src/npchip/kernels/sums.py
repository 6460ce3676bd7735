"""Kernels in one direction as sums of signed powers of two, and what these sums share.

A *signal* is a number for each place of a strip of pixels. A *term* is a signal some places
further, times a power of two, added or subtracted. The products of a kernel with constants are
written in canonical signed digits, the form with the fewest non-zero digits: 7 is 8 - 1. Pairs of
terms that occur more than once, at whatever place and multiplied by whatever power of two, become
a signal of their own, the most frequent pair first (Hartley 1996, "Subexpression sharing in
filters using canonic signed digit multipliers").
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from typing import NamedTuple

Weights = Mapping[tuple[str, int], int]
"""Weight of each signal and place of a sum."""


class Term(NamedTuple):
    """A signal ``at`` places further, times ``sign * 2**shift``."""

    signal: str
    at: int
    shift: int
    sign: int


class Pair(NamedTuple):
    """``first + sign * 2**shift * second``, where second stands ``at`` places further.

    Where ``of_first`` is true it is the first that is multiplied by ``2**shift``.
    """

    first: str
    second: str
    at: int
    shift: int
    sign: int
    of_first: bool

    @property
    def terms(self) -> tuple[Term, Term]:
        """The pair as two terms."""
        left, right = (self.shift, 0) if self.of_first else (0, self.shift)
        return Term(self.first, 0, left, 1), Term(self.second, self.at, right, self.sign)


class Sums(NamedTuple):
    """Sums to be computed at each place.

    Attributes:
        shared: signals that occur more than once, each before those that use it.
        results: terms of each result.
    """

    shared: dict[str, tuple[Term, ...]]
    results: dict[str, tuple[Term, ...]]

    @property
    def named(self) -> tuple[tuple[str, tuple[Term, ...]], ...]:
        """All of them, with their names."""
        return (*self.shared.items(), *self.results.items())


def signed_digits(number: int) -> Iterator[tuple[int, int]]:
    """Yield shift and sign of the canonical signed digits of a number, the lowest first."""
    shift = 0
    while number:
        if number & 1:
            sign = 2 - (number & 3)
            yield shift, sign
            number -= sign
        number >>= 1
        shift += 1


def terms_of(weights: Weights) -> list[Term]:
    """The terms of a sum in canonical signed digits."""
    return [
        Term(signal, at, shift, sign)
        for (signal, at), weight in weights.items()
        for shift, sign in signed_digits(weight)
    ]


def formula(terms: Sequence[Term], place: str) -> str:
    """Write a sum down, such as ``p(x) + 2 p(x + 1)``."""
    text = ""
    for term in sorted(terms, key=lambda term: (-term.sign, term.at)):
        sign = "-" if term.sign < 0 else "+"
        factor = f"{1 << term.shift} " if term.shift else ""
        at = f" {'+' if term.at > 0 else '-'} {abs(term.at)}" if term.at else ""
        text += f" {sign} {factor}{term.signal}({place}{at})"
    return text.strip().removeprefix("+ ")


def share(results: Mapping[str, Weights], prefix: str, *, split: bool = True) -> Sums:
    """Write sums in signed digits and give a name to what occurs more than once in them.

    Args:
        results: weights of each result.
        prefix: what the names of new signals begin with.
        split: also share by splitting a term: a + 2b + c, of one signal at three places that
            follow each other, is (a + b) + (b + c).
    """
    sums = {name: terms_of(weights) for name, weights in results.items()}
    found = {name: _counted(terms, split=split) for name, terms in sums.items()}
    shared: dict[str, tuple[Term, ...]] = {}
    while True:
        counts: Counter[Pair] = Counter()
        for pairs in found.values():
            counts.update(pairs)
        best = max(
            counts, key=lambda pair: (counts[pair], -abs(pair.at), -pair.shift), default=None
        )
        if best is None or counts[best] < 2:
            return Sums(shared, {name: tuple(terms) for name, terms in sums.items()})
        new = f"{prefix}{len(shared) + 1}"
        shared[new] = best.terms
        for name in [name for name, pairs in found.items() if best in pairs]:
            sums[name] = _replaced(sums[name], best, new, split=split)
            found[name] = _counted(sums[name], split=split)


def _pair(one: Term, other: Term) -> tuple[Pair, Term]:
    """The pair of two terms, and the term that stands for it, still without its signal."""
    first, second = sorted((one, other), key=lambda term: (term.signal, term.at, term.shift))
    shift = second.shift - first.shift
    pair = Pair(
        first.signal,
        second.signal,
        second.at - first.at,
        abs(shift),
        first.sign * second.sign,
        of_first=shift < 0,
    )
    return pair, Term("", first.at, min(first.shift, second.shift), first.sign)


def _counted(terms: Sequence[Term], *, split: bool) -> Counter[Pair]:
    """Count how many times each pair can be taken out of a sum, no term twice."""
    counts: Counter[Pair] = Counter()
    taken: set[tuple[Pair, Term]] = set()
    for one, other in combinations(terms, 2):
        pair, _ = _pair(one, other)
        if (pair, one) not in taken and (pair, other) not in taken:
            taken |= {(pair, one), (pair, other)}
            counts[pair] += 1
    if split:
        for triple in _triples(terms):
            pair, _ = _pair(*_halves(triple)[0])
            counts[pair] += 2
    return counts


def _triples(terms: Sequence[Term]) -> Iterator[tuple[Term, Term, Term]]:
    """Terms like a + 2b + c or a - 2b + c: of one signal, at equal distances."""
    known = set(terms)
    for first in terms:
        for middle in terms:
            if (
                middle.signal == first.signal
                and middle.at > first.at
                and middle.shift == first.shift + 1
            ):
                last = first._replace(at=2 * middle.at - first.at)
                if last in known:
                    yield first, middle, last


def _halves(triple: tuple[Term, Term, Term]) -> tuple[tuple[Term, Term], tuple[Term, Term]]:
    first, middle, last = triple
    half = middle._replace(shift=first.shift)
    return (first, half), (half, last)


def _replaced(terms: Sequence[Term], pair: Pair, name: str, *, split: bool) -> list[Term]:
    """A sum in which a pair is written as the signal of that name."""
    rest = list(terms)
    found: list[Term] = []
    if split:
        for triple in _triples(terms):
            halves = _halves(triple)
            if all(term in rest for term in triple) and _pair(*halves[0])[0] == pair:
                found += [_pair(*half)[1]._replace(signal=name) for half in halves]
                for term in triple:
                    rest.remove(term)
    for one, other in combinations(list(rest), 2):
        if one in rest and other in rest and one is not other:
            which, whole = _pair(one, other)
            if which == pair:
                found.append(whole._replace(signal=name))
                rest.remove(one)
                rest.remove(other)
    return rest + found
