"""Syntax highlighting: a Pygments lexer and a TextMate grammar from one set of rules."""
