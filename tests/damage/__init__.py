"""Damaged files: bytes changed, cut out, added, and what npchip makes of them beside others.

By hand: ``python -m tests.damage --format png --count 500``.
"""
