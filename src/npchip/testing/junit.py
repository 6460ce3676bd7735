"""Reports as JUnit XML, for continuous integration."""

from __future__ import annotations

import re
from collections.abc import Sequence
from xml.etree import ElementTree as ET

from npchip.testing.harness import Report
from npchip.testing.report import outcome_lines

_FORBIDDEN = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_TAGS = {"failed": "failure", "error": "error"}


def junit(reports: Sequence[Report]) -> bytes:
    """Return the reports as UTF-8, a suite for each program and a case for each run."""
    root = ET.Element("testsuites", name="npchip")
    _count(root, reports)
    for report in reports:
        suite = ET.SubElement(root, "testsuite", name=_clean(str(report.program)))
        _count(suite, [report])
        path = _clean(str(report.program.with_suffix("")))
        for outcome in report.outcomes:
            case = _case(suite, path, _clean(outcome.case.name), outcome.seconds)
            if outcome.state != "passed":
                _add(case, _TAGS[outcome.state], outcome_lines(outcome))
        if report.problems:
            tag = "error" if report.broken else "failure"
            _add(_case(suite, path, "(file)"), tag, report.problems)
        if report.untested or report.unrun:
            message = _clean(report.unrun) or "no tests"
            ET.SubElement(_case(suite, path, "(file)"), "skipped", message=message)
    ET.indent(root, " ")
    text: bytes = ET.tostring(root, "utf-8", xml_declaration=True)
    return text + b"\n"


def _case(suite: ET.Element, path: str, name: str, seconds: float = 0.0) -> ET.Element:
    dotted = path.replace("\\", "/").replace("/", ".")
    return ET.SubElement(suite, "testcase", classname=dotted, name=name, time=f"{seconds:.3f}")


def _add(case: ET.Element, tag: str, lines: Sequence[str]) -> None:
    element = ET.SubElement(case, tag, message=_clean(lines[0].split("\n")[0]))
    element.text = _clean("\n".join(lines))


def _count(element: ET.Element, reports: Sequence[Report]) -> None:
    states = {state: sum(report.count(state) for report in reports) for state in _TAGS}
    untested = sum(report.untested or bool(report.unrun) for report in reports)
    passed = sum(report.count("passed") for report in reports)
    element.set("tests", str(passed + sum(states.values()) + untested))
    element.set("failures", str(states["failed"]))
    element.set("errors", str(states["error"]))
    element.set("skipped", str(untested))
    seconds = sum(outcome.seconds for report in reports for outcome in report.outcomes)
    element.set("time", f"{seconds:.3f}")


def _clean(text: str) -> str:
    return _FORBIDDEN.sub("\N{REPLACEMENT CHARACTER}", text)
