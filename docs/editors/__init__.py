"""Editors: the extension of VS Code, and the command that packs it."""
