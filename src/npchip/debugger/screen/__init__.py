"""The terminal application of the debugger; needs Textual."""
