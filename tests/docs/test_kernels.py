"""docs/kernels.md: its tables are what the compiler gives."""

from __future__ import annotations

import pytest

from examples import kernels_page


@pytest.mark.long
def test_the_tables_of_kernels_are_what_the_compiler_gives() -> None:
    page = kernels_page.PAGE.read_text(encoding="utf-8")
    assert page.count("<!-- end -->") == 2
    assert page == kernels_page.document(page), "python -m examples.kernels_page writes it"
