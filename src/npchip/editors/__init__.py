"""Sources in colour: rules from the instruction set, as a Pygments lexer and a TextMate grammar."""
