"""The part of the studio that runs in Pyodide: npchip's own tool chain, asked by the page."""
