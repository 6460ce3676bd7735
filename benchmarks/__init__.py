"""How fast it all is: ``python -m benchmarks``."""
