"""The code generator: writes WebAssembly from a translated program. Needs no NumPy or wasmtime."""
