"""Programs as files: assembled objects (``.npo``), ROM images as text and as bytes."""

from npchip.formats.files import load_program, write_program

__all__ = ["load_program", "write_program"]
