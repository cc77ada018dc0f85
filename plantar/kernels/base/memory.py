"""Access to an array's memory for interpreted kernels (compiled: `pointers.pxd`).

A buffer costs a kernel 0.1 us, its memory 5 ns.
"""

import numpy as np

__all__ = ["close", "flags", "is_array", "is_mask", "new_mask", "new_matrix", "new_vector"]
__all__ += ["room", "rows", "size", "values"]


def values(array):
    """Contiguous float64 array's numbers, in place; else ValueError."""
    if type(array) is not np.ndarray or array.dtype != np.float64 or not array.flags.c_contiguous:
        raise ValueError("a kernel needs contiguous arrays of float64")
    return array.reshape(-1)


def room(array):
    """Contiguous, writable float64 array's numbers, in place; else ValueError."""
    numbers = values(array)
    if not array.flags.writeable:
        raise ValueError("a kernel needs arrays that may be written")
    return numbers


def size(array):
    """Number of values that `values` accepts; -1 for anything else."""
    if type(array) is not np.ndarray or array.dtype != np.float64 or array.ndim != 1 or not array.flags.c_contiguous:
        return -1
    return array.shape[0]


def rows(array, columns):
    """Number of rows of a matrix of so many columns that `values` accepts; else -1."""
    if type(array) is not np.ndarray or array.dtype != np.float64 or array.ndim != 2 or not array.flags.c_contiguous:
        return -1
    return array.shape[0] if array.shape[1] == columns else -1


def is_array(value):
    """Whether this is an array."""
    return isinstance(value, np.ndarray)


def is_mask(array, size):
    """Whether this is a contiguous array of so many bools."""
    plain = type(array) is np.ndarray and array.dtype == np.bool_ and array.flags.c_contiguous
    return plain and array.shape == (size,)


def flags(array):
    """Bools of an array that `is_mask`, in place."""
    return array


def close(array):
    """Close an array to writing."""
    array.setflags(write=False)


def new_mask(size):
    """New array (size,) of bools, not filled."""
    return np.empty(size, dtype=np.bool_)


def new_vector(size):
    """New array (size,) of float64, not filled."""
    return np.empty(size)


def new_matrix(rows, columns):
    """New array (rows, columns) of float64, not filled."""
    return np.empty((rows, columns))
