"""The host: runs a translated program's module in wasmtime."""
