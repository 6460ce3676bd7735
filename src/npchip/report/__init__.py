"""Results as JSON, tables, files and pictures; independent of engines and of click."""
