"""Tests of the language server with a real client on standard input and output."""
