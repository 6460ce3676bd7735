"""Tools for every package: errors, files, YAML with places, its keys, JSON, suggestions."""
