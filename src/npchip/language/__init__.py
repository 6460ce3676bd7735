"""Answers to editors about a source, for the studio's page and the language server."""
