"""``python -m tests.agreement``: both engines on a million random programs."""
