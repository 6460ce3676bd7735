"""The debugger's terminal application. It needs Textual."""
