"""The documents as a web site: ``python -m docs.site FOLDER``."""
