"""A profile for other tools: lcov tracefiles (genhtml, editors) and speedscope.

Formats: ``geninfo(1)`` of the LTP GCOV extension; https://www.speedscope.app/file-format-schema.json.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from npchip.base.json import one_line
from npchip.engines.rows import EXECUTED
from npchip.profile.model import called, entries
from npchip.profile.text import code

if TYPE_CHECKING:
    from npchip.profile.model import Profile
    from npchip.program.model import SourceLine


def lcov(profile: Profile) -> str:
    """Return the coverage of lines, routines and outcomes, file by file.

    The count of a line is that of its words. A line that expands to others counts how often its
    words were entered from outside, so that a loop in them counts once. Copies of a line are added
    up. Outcomes of a mask count NPs, outcomes of a branch count executions; the block number is the
    address.
    """
    lines: dict[str, dict[int, int]] = defaultdict(lambda: defaultdict(int))
    expanded: dict[SourceLine, list[int]] = defaultdict(list)
    for word in profile.words:
        if word.place is None:
            continue
        lines[word.place.file][word.place.line] += word.executions
        for line in word.place.origins[1:]:
            expanded[line].append(word.address)
    outer: dict[tuple[str, int], int] = defaultdict(int)
    for line, addresses in expanded.items():
        outer[line.file, line.line] += entries(profile, min(addresses), max(addresses) + 1)
    for (file, number), count in outer.items():
        lines[file].setdefault(number, count)
    parts = [_file(profile, file, dict(found)) for file, found in lines.items()]
    return "".join(f"{line}\n" for part in parts for line in part)


def _file(profile: Profile, file: str, lines: dict[int, int]) -> Iterator[str]:
    yield "TN:"
    yield f"SF:{file}"
    routines = [
        (place.written_at.line, call)
        for call in _routines(profile).values()
        if (place := profile.program.place(call[1])) and place.written_at.file == file
    ]
    for line, (name, _, _) in routines:
        yield f"FN:{line},{name}"
    for _, (name, _, calls) in routines:
        yield f"FNDA:{calls},{name}"
    yield f"FNF:{len(routines)}"
    yield f"FNH:{sum(calls > 0 for _, (_, _, calls) in routines)}"
    outcomes = hit = 0
    for branch in profile.branches:
        place = profile.program.place(branch.address)
        if place is None or place.file != file:
            continue
        executed = profile.words[branch.address].executions
        for number, count in enumerate((branch.yes, branch.no)):
            yield f"BRDA:{place.line},{branch.address},{number},{count if executed else '-'}"
            outcomes, hit = outcomes + 1, hit + (count > 0)
    yield f"BRF:{outcomes}"
    yield f"BRH:{hit}"
    for number in sorted(lines):
        yield f"DA:{number},{lines[number]}"
    yield f"LF:{len(lines)}"
    yield f"LH:{sum(count > 0 for count in lines.values())}"
    yield "end_of_record"


def _routines(profile: Profile) -> dict[int, tuple[str, int, int]]:
    """Return name, address and number of calls for the target of each call."""
    names = profile.program.label_names
    found: dict[int, tuple[str, int, int]] = {}
    for decoded in profile.decoded:
        if decoded is not None and "call" in decoded.form.effects:
            target = decoded.target
            if target is not None and target < len(profile.words):
                found[target] = (names.get(target, f"0x{target:03X}"), target, 0)
    for _, call in profile.calls.walk():
        if call.address in found:
            name, target, calls = found[call.address]
            found[call.address] = (name, target, calls + call.calls)
    return dict(sorted(found.items()))


def speedscope(profile: Profile) -> str:
    """Return cycles by call, label and line as a file of https://www.speedscope.app."""
    frames: dict[tuple[str, str | None, int | None], int] = {}
    samples: list[list[int]] = []
    weights: list[int] = []

    def number(name: str, place: SourceLine | None) -> int:
        line = place.line if place else None
        return frames.setdefault((name, place.file if place else None, line), len(frames))

    program, names = profile.program, profile.program.label_names
    for stack, table in profile.stacks.items():
        path = [number(profile.calls.name, program.place(0))]
        path += [
            number(names.get(target, f"0x{target:03X}"), program.place(target))
            for target in called(profile.decoded, stack)
        ]
        for address, count in enumerate(table[EXECUTED].tolist()):
            if not count or not profile.costs[address]:
                continue
            label = profile.label_at(address)
            own = number(label.name, program.place(label.address))
            place = program.place(address)
            text = f"{place.line}: {code(place.text)}" if place else f"0x{address:03X}"
            inner = [own] if own != path[-1] else []
            samples.append([*path, *inner, number(text, place)])
            weights.append(count * profile.costs[address])
    document: dict[str, Any] = {
        "$schema": "https://www.speedscope.app/file-format-schema.json",
        "name": f"{program.name}: cycles on machine {profile.result.machine}",
        "exporter": "npchip",
        "activeProfileIndex": 0,
        "shared": {
            "frames": [
                {"name": name} | ({"file": file} if file else {}) | ({"line": line} if line else {})
                for name, file, line in frames
            ]
        },
        "profiles": [
            {
                "type": "sampled",
                "name": program.name,
                "unit": "none",
                "startValue": 0,
                "endValue": sum(weights),
                "samples": samples,
                "weights": weights,
            }
        ],
    }
    return f"{one_line(document)}\n"
