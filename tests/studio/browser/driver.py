"""Run flows in a browser: a process of Node drives it, and answers in lines of JSON."""

from __future__ import annotations

import json
import queue
import subprocess
import threading
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.support.page_code import MODULES

if TYPE_CHECKING:
    from collections.abc import Mapping

AXE = MODULES / "axe-core" / "axe.min.js"
SECONDS = 240
"""Until a process that does not answer is given up; flows have shorter times of their own."""


@dataclass
class Driver:
    """A browser that runs flows, one after the other, each in a context of its own.

    Attributes:
        kind: ``chromium`` or ``firefox``.
        executable: the browser.
        node: Node.
        script: the flows, bundled.
        camera: what Chromium's camera sees.
    """

    kind: str
    executable: Path
    node: Path
    script: Path
    camera: Path
    _process: subprocess.Popen[str] | None = field(default=None, init=False)
    _lines: queue.Queue[str | None] = field(default_factory=queue.Queue, init=False)

    def run(
        self,
        flow: str,
        url: str,
        folder: Path,
        seconds: float = SECONDS,
        **parameters: object,
    ) -> dict[str, Any]:
        """Run a flow and return what it reports; fail the test if the flow fails.

        Args:
            flow: name of the flow.
            url: address of the page.
            folder: where a failed flow leaves screenshot, console and page.
            seconds: until it is given up.
            parameters: what the flow reads with `t.parameter`.
        """
        answer = self.answer(flow, url, folder, seconds, parameters)
        if not answer["ok"]:
            pytest.fail(f"{self.kind}: {answer['error']}\nsee {folder}", pytrace=False)
        report: dict[str, Any] = answer["report"]
        return report

    def answer(
        self,
        flow: str,
        url: str,
        folder: Path,
        seconds: float = SECONDS,
        parameters: Mapping[str, object] | None = None,
    ) -> dict[str, Any]:
        """Run a flow and return what came of it: keys ``ok``, ``error`` and ``report``."""
        process = self._started()
        job = {"flow": flow, "url": url, "folder": str(folder), "parameters": parameters or {}}
        assert process.stdin
        process.stdin.write(json.dumps(job) + "\n")
        process.stdin.flush()
        try:
            line = self._lines.get(timeout=seconds)
        except queue.Empty:
            self.close(gently=False)
            pytest.fail(f"{self.kind}: '{flow}' did not answer within {seconds:.0f} s")
        if line is None:
            code = process.wait()
            self._process = None
            pytest.fail(f"{self.kind}: the driver ended with exit code {code} in '{flow}'")
        answer: dict[str, Any] = json.loads(line)
        return answer

    def close(self, gently: bool = True) -> None:
        """End the browser and the process."""
        if not self._process:
            return
        process, self._process = self._process, None
        assert process.stdin
        if not gently:
            process.terminate()  # Node ends its browser with it
        process.stdin.close()
        try:
            process.wait(30)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def _started(self) -> subprocess.Popen[str]:
        if self._process and self._process.poll() is None:
            return self._process
        self._process = process = subprocess.Popen(
            [self.node, "--enable-source-maps", self.script],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            encoding="utf-8",
        )
        lines: queue.Queue[str | None] = queue.Queue()
        self._lines = lines
        assert process.stdin
        assert process.stdout
        stdout = process.stdout

        def read() -> None:
            with stdout:
                for line in stdout:
                    lines.put(line)
            lines.put(None)

        threading.Thread(target=read, daemon=True).start()
        setup = {
            "kind": self.kind,
            "executable": str(self.executable),
            "camera": str(self.camera),
            "axe": str(AXE),
        }
        process.stdin.write(json.dumps(setup) + "\n")
        process.stdin.flush()
        return process
