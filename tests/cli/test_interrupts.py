"""Ctrl-C is not lost where nobody could catch it."""

from __future__ import annotations

import subprocess
import sys

import pytest

from npchip.cli.interrupts import is_interrupt

LOST = {
    "a finalizer": """
class Lost:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(1)
def lose():
    Lost()
""",
    "a callback of a weak reference": """
class Lost:
    pass
def callback(_):
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(1)
def lose():
    lost = Lost()
    kept.append(weakref.ref(lost, callback))
""",
    "the making of a class": """
class Field:
    def __set_name__(self, owner, name):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(1)
def lose():
    type("Lost", (), {"field": Field()})
""",
}


@pytest.mark.skipif(sys.platform == "win32", reason="sends itself a signal")
@pytest.mark.parametrize("name", LOST)
def test_an_interrupt_ends_the_command_wherever_it_comes(name: str) -> None:
    script = (
        "import os, signal, time, weakref\nfrom npchip.cli import main\nkept = []\n"
        + LOST[name]
        + "@main.cli.command()\ndef wait():\n    lose()\n    time.sleep(20)\n"
        + "main.COMMANDS['wait'] = main.COMMANDS['run']\n"
        + "main.CommandLine.get_command = lambda *_: wait\nmain.main()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, "wait"],
        check=False,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert (done.returncode, done.stderr.strip()) == (130, "interrupted")


def test_an_interrupt_is_found_below_other_exceptions() -> None:
    error = RuntimeError()
    error.__cause__ = ValueError()
    assert not is_interrupt(error)
    error.__cause__.__context__ = KeyboardInterrupt()
    assert is_interrupt(error)
