"""Tools for every package: errors, files written whole, YAML with places, JSON, suggestions."""
