"""Memory, small vectors, work arrays, fused products and checks, for all kernels."""

from contextlib import nullcontext
from types import SimpleNamespace

__all__ = ["without_cython"]

without_cython = SimpleNamespace(compiled=False, nogil=nullcontext(), gil=nullcontext())
"""What interpreted kernels find of the module `cython` where it is not installed: a lock is neither released nor taken
again."""
