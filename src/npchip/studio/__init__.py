"""The studio: npchip in a browser tab."""
