"""The compiled engine: translates a whole program to WebAssembly SIMD."""
