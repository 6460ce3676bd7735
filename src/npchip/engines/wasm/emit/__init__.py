"""From values to a WebAssembly module; needs neither NumPy nor wasmtime."""
