"""Tools for every package: errors, files, YAML with line numbers, JSON, suggestions."""
