"""The module at work in its host."""
