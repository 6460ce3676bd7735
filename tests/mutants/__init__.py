"""``python -m tests.mutants``: small mistakes planted in the package, to see if tests notice."""
