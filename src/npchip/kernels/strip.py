"""The sums of a strip of places in straight code, each shared signal computed once a place."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence

from npchip.kernels.numbers import Arithmetic, Number
from npchip.kernels.sums import Sums, Term

Instance = tuple[str, int]
"""A signal at a place."""


class Strip:
    """Writes the sums of a strip.

    Args:
        arithmetic: where and how wide.
        sums: what to compute.
        places: where the results are wanted, in order.
        load: writes the code that reads a signal at a place which is no sum. It may add other
            instances to `values`.
    """

    def __init__(
        self,
        arithmetic: Arithmetic,
        sums: Sums,
        places: Sequence[int],
        load: Callable[[str, int], Number],
    ) -> None:
        self._do = arithmetic
        self._sums = sums
        self._load = load
        self.values: dict[Instance, Number] = {}
        self.uses: Counter[Instance] = Counter()
        for place in places:
            for terms in sums.results.values():
                self._count(terms, place)

    def result(self, name: str, place: int, constant: int = 0) -> tuple[Number, bool]:
        """Compute a result; also tell whether its registers may be changed.

        Args:
            name: the result.
            place: where.
            constant: added to it.
        """
        return self._total(self._sums.results[name], place, f"{name}({place})", constant)

    def needed(self, place: int) -> list[Instance]:
        """Loaded signals that the results at a place need and that are not there yet."""
        found: dict[Instance, None] = {}

        def look(terms: Iterable[Term], place: int) -> None:
            for term in terms:
                instance = (term.signal, place + term.at)
                if instance not in self.values:
                    if term.signal in self._sums.shared:
                        look(self._sums.shared[term.signal], place + term.at)
                    else:
                        found[instance] = None

        for terms in self._sums.results.values():
            look(terms, place)
        return list(found)

    def fetch(self, instance: Instance) -> Number:
        """Return the value of a signal at a place, computed or loaded now if need be."""
        if instance not in self.values:
            signal, place = instance
            if signal in self._sums.shared:
                terms = self._sums.shared[signal]
                number, own = self._total(terms, place, f"{signal}({place})")
                self.values[instance] = number if own else self._do.copy(number)
            else:
                self.values[instance] = self._load(signal, place)
        return self.values[instance]

    def _count(self, terms: Iterable[Term], place: int) -> None:
        for term in terms:
            instance = (term.signal, place + term.at)
            if not self.uses[instance] and term.signal in self._sums.shared:
                self._count(self._sums.shared[term.signal], place + term.at)
            self.uses[instance] += 1

    def _total(
        self, terms: Sequence[Term], place: int, name: str, constant: int = 0
    ) -> tuple[Number, bool]:
        """Add terms up from the highest power of two, doubling in between."""
        do = self._do
        shifts = sorted({term.shift for term in terms}, reverse=True)
        total: Number | None = None
        negative = False  # total is the number that is meant, times -1
        for shift, following in zip(shifts, [*shifts[1:], 0], strict=True):
            group = [term for term in terms if term.shift == shift]
            for term in group:
                self.fetch((term.signal, place + term.at))
            if total is None:
                do.code.note(name)
                first = min(group, key=lambda term: (term.sign < 0, not self._last(term, place)))
                group.remove(first)
                negative = first.sign < 0
                if len(terms) == 1 and not shift and not negative and not constant:
                    instance = (first.signal, place + first.at)
                    own = self._last(first, place)
                    return self._used(instance), own
                total = self._start(first, place)
            for term in sorted(group, key=lambda term: term.sign * (1 if negative else -1)):
                total, negative = self._with(total, negative, term, place)
            if shift - following:
                total = do.doubled(total, shift - following)
        assert total is not None
        if negative:
            return do.minus(do.constant(constant), total), True
        return do.plus_constant(total, constant), True

    def _with(self, total: Number, negative: bool, term: Term, place: int) -> tuple[Number, bool]:
        if negative and term.sign > 0:
            start = self._start(term, place)
            return self._do.minus(start, total), False
        other = self._used((term.signal, place + term.at))
        if term.sign > 0 or negative:
            return self._do.plus(total, other), negative
        return self._do.minus(total, other), False

    def _last(self, term: Term, place: int) -> bool:
        return self.uses[term.signal, place + term.at] == 1

    def _start(self, term: Term, place: int) -> Number:
        """A number that may be changed, from a term."""
        last = self._last(term, place)
        number = self._used((term.signal, place + term.at))
        return number if last else self._do.copy(number)

    def _used(self, instance: Instance) -> Number:
        self.uses[instance] -= 1
        return self.values[instance]
