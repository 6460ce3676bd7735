"""The language server, ``npchip lsp``: `npchip.language` behind the Language Server Protocol."""
