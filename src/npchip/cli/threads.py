"""One thread for linear algebra: what is learnt must not depend on the number of cores."""

from __future__ import annotations

import os

_THREADS = ("OPENBLAS_NUM", "MKL_NUM", "OMP_NUM", "BLIS_NUM", "VECLIB_MAXIMUM")


def use_one_thread() -> None:
    """Let libraries for linear algebra use one thread; call before NumPy is imported.

    The order of their additions, and so what a network learns, depends on the number of threads.
    One is also the fastest for matrices as small as these.
    """
    for name in _THREADS:
        os.environ[f"{name}_THREADS"] = "1"
