"""Translates a program to the values of its blocks; needs neither NumPy nor wasmtime."""
