"""Damage many files: ``python -m tests.damage --format png --count 500``."""

from __future__ import annotations

import argparse
import faulthandler
import tempfile
import time
from collections import Counter
from pathlib import Path

from tests.damage.bases import FORMS
from tests.damage.trial import make, try_one


def main() -> int:
    """Try damaged files and print what is wrong; return 1 if anything is."""
    options = argparse.ArgumentParser(prog="python -m tests.damage", description=__doc__)
    options.add_argument("--format", action="append", choices=FORMS, help="all if not given")
    options.add_argument("--count", type=int, default=500, help="files of each format")
    options.add_argument("--seed", type=int, default=0, help="of the first file")
    options.add_argument("--keep", type=Path, help="folder for the files with faults")
    chosen = options.parse_args()
    faulthandler.enable()
    total = 0
    for form in chosen.format or FORMS:
        started, faults = time.perf_counter(), Counter[str]()
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for seed in range(chosen.seed, chosen.seed + chosen.count):
                fault = try_one(form, seed, folder)
                if fault is None:
                    continue
                faults[fault.kind] += 1
                print(f"{form} seed {seed}, {fault.base}: {fault.kind}: {fault.text}", flush=True)
                if chosen.keep:
                    kept = chosen.keep / f"{form}-{seed}{Path(fault.base).suffix}"
                    kept.write_bytes(make(form, seed, folder)[0].read_bytes())
        total += faults.total()
        listed = ", ".join(f"{count} {kind}" for kind, count in faults.items()) or "no fault"
        taken = time.perf_counter() - started
        print(f"{form}: {chosen.count} files, {listed}, {taken:.0f} s", flush=True)
    return int(total > 0)


if __name__ == "__main__":
    raise SystemExit(main())
