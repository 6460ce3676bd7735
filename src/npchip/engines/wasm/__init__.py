"""The engine to run with: a whole program translated to WebAssembly SIMD."""
