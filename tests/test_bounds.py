"""Lower bounds of pyproject.toml, as `.ci/run` installs them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support import lowest


def test_every_dependency_of_users_and_tests_has_a_lower_bound() -> None:
    users = lowest.lowest("debug", "orient", "plot", "trace", "video")
    tests = lowest.lowest("test")
    assert users["click"] == "8.1.8"
    assert users["wasmtime"] == "45"
    assert set(users) <= set(tests)
    assert tests["click"] == "8.2"
    assert set(lowest.lowest("dev")) > set(tests)


def test_a_dependency_without_a_lower_bound_is_an_error(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    file = tmp_path / "pyproject.toml"
    file.write_text('[project]\ndependencies = ["numpy<3"]\n[project.optional-dependencies]\n')
    monkeypatch.setattr(lowest, "PROJECT", file)
    with pytest.raises(ValueError, match="numpy<3"):
        lowest.lowest()
