"""The compiler of the page: npchip's tool chain behind JSON, where there is no NumPy.

It runs in Pyodide, and in CPython where the site is built. Requests and answers are those of the
interface ``Compiler`` in ``page/protocol.ts``.
"""
