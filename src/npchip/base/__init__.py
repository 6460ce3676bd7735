"""What every package may use: errors, files written whole, YAML with places, suggestions."""
