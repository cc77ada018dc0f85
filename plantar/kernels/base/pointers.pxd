# What memory.py does, for compiled kernels: an array's numbers by a pointer, and new arrays by numpy's own C functions.
# A kernel imports memory, and its .pxd cimports this file under that name. Without a compiler this file is not read.
cimport numpy as cnp

cdef extern from "numpy/arrayobject.h":
    void* PyArray_API

cdef inline double* values(object array) except NULL:
    if (
        type(array) is not cnp.ndarray
        or cnp.PyArray_TYPE(<cnp.ndarray> array) != cnp.NPY_DOUBLE
        or not cnp.PyArray_ISCARRAY_RO(<cnp.ndarray> array)
    ):
        raise ValueError("a kernel needs contiguous arrays of float64")
    return <double*> cnp.PyArray_DATA(<cnp.ndarray> array)

cdef inline double* room(object array) except NULL:
    cdef double* numbers = values(array)
    if not cnp.PyArray_ISWRITEABLE(<cnp.ndarray> array):
        raise ValueError("a kernel needs arrays that may be written")
    return numbers

cdef inline bint _is_plain(object array, int kind, int dimensions) noexcept:
    return (
        type(array) is cnp.ndarray
        and cnp.PyArray_TYPE(<cnp.ndarray> array) == kind
        and cnp.PyArray_NDIM(<cnp.ndarray> array) == dimensions
        and cnp.PyArray_ISCARRAY_RO(<cnp.ndarray> array)
    )

cdef inline Py_ssize_t size(object array) noexcept:
    return cnp.PyArray_DIM(<cnp.ndarray> array, 0) if _is_plain(array, cnp.NPY_DOUBLE, 1) else -1

cdef inline Py_ssize_t rows(object array, Py_ssize_t columns) noexcept:
    if not _is_plain(array, cnp.NPY_DOUBLE, 2) or cnp.PyArray_DIM(<cnp.ndarray> array, 1) != columns:
        return -1
    return cnp.PyArray_DIM(<cnp.ndarray> array, 0)

cdef inline bint is_array(object value) noexcept:
    return isinstance(value, cnp.ndarray)

cdef inline bint is_mask(object array, Py_ssize_t size) noexcept:
    return _is_plain(array, cnp.NPY_BOOL, 1) and cnp.PyArray_DIM(<cnp.ndarray> array, 0) == size

cdef inline unsigned char* flags(object array) noexcept:
    return <unsigned char*> cnp.PyArray_DATA(<cnp.ndarray> array)

cdef inline void close(object array) noexcept:
    cnp.PyArray_CLEARFLAGS(<cnp.ndarray> array, cnp.NPY_ARRAY_WRITEABLE)

cdef inline object new_mask(Py_ssize_t size):
    cdef cnp.npy_intp shape = size
    if PyArray_API == NULL:
        cnp.import_array()
    return cnp.PyArray_SimpleNew(1, &shape, cnp.NPY_BOOL)

cdef inline object new_vector(Py_ssize_t size):
    cdef cnp.npy_intp shape = size
    if PyArray_API == NULL:  # each extension asks numpy for its functions once
        cnp.import_array()
    return cnp.PyArray_SimpleNew(1, &shape, cnp.NPY_DOUBLE)

cdef inline object new_matrix(Py_ssize_t rows, Py_ssize_t columns):
    cdef cnp.npy_intp[2] shape
    shape[0], shape[1] = rows, columns
    if PyArray_API == NULL:
        cnp.import_array()
    return cnp.PyArray_SimpleNew(2, shape, cnp.NPY_DOUBLE)
