"""Measure speed: ``python -m benchmarks``."""
