"""Results as JSON, tables, files and pictures. No module here knows of engines or of click."""
