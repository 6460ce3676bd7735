"""The tests of npchip, with their oracles and helpers."""
