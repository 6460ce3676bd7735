"""Convolution kernels to programs: ``npchip kernel``."""

from npchip.kernels.compile import Compiled, compile_kernels
from npchip.kernels.model import Kernel, read_kernel, shift_of

__all__ = ["Compiled", "Kernel", "compile_kernels", "read_kernel", "shift_of"]
