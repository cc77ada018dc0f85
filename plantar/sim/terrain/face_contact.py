"""Continuous contacts of marked boxes and cylinders in MuJoCo's collision table.

MuJoCo's own contacts of nearly parallel boxes jump between one and four with a nanometre of motion.
"""

import ctypes
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mujoco

from plantar.errors import InputError
from plantar.kernels.contacts.face_contacts import FaceContacts

MARK = 1 << 29
"""Bit of `contype` of a geom whose flat faces carry soles; no geom's `conaffinity` answers to it."""

_BOX = int(mujoco.mjtGeom.mjGEOM_BOX)
_CYLINDER = int(mujoco.mjtGeom.mjGEOM_CYLINDER)
_KINDS = 9  # geom types, as of mjNGEOMTYPES
_SEARCHED = 1 << 18  # bytes at the head of a structure of MuJoCo in which its arrays' addresses are
_Function = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.c_size_t, ctypes.c_size_t, ctypes.c_size_t, ctypes.c_int, ctypes.c_int, ctypes.c_double
)
_installed: list[Any] = []  # the functions in the table, which must live as long as the process


def install_face_contacts() -> None:
    """Put marked geoms' contacts into MuJoCo's collision table, once a process."""
    if _installed:
        return
    table = (ctypes.c_void_p * (_KINDS * _KINDS)).in_dll(_library(), "mjCOLLISIONFUNC")
    addresses = _Addresses()
    contacts = FaceContacts(_stride())
    for kind, find in ((_BOX, contacts.box), (_CYLINDER, contacts.cylinder)):
        entry = kind * _KINDS + _BOX
        function = _Function(_collide(find, _Function(table[entry] or 0), addresses))
        _installed.append(function)
        table[entry] = ctypes.cast(function, ctypes.c_void_p).value


class _Addresses:
    """Byte offsets of array addresses in MuJoCo's structures."""

    def __init__(self) -> None:
        model, data = _spheres()
        self.contype = _offset(model, model.geom_contype)
        self.sizes = _offset(model, model.geom_size)
        self.places = _offset(data, data.geom_xpos)
        self.turns = _offset(data, data.geom_xmat)


def _offset(structure: Any, array: Any) -> int:
    """Bytes from the head of a structure to an array's address."""
    wanted = array.ctypes.data
    word = ctypes.sizeof(ctypes.c_size_t)
    for offset in range(0, _SEARCHED, word):
        if ctypes.c_size_t.from_address(structure._address + offset).value == wanted:
            return offset
    raise InputError(f"MuJoCo {mujoco.__version__} keeps its arrays where no contact on ground can be made from them")


def _stride() -> int:
    if hasattr(mujoco, "MjPreContact"):  # since MuJoCo 4: gap, position, normal and tangent alone
        return 10 * ctypes.sizeof(ctypes.c_double)
    return int(_spheres()[1].contact.dist.strides[0])


def _spheres() -> tuple[Any, Any]:
    """Smallest model and data of touching spheres: MuJoCo's empty arrays share addresses with the next."""
    sphere = "<geom size='1'/>"
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco><worldbody>{sphere}<body><freejoint/>{sphere}</body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def _library() -> ctypes.CDLL:
    for path in Path(mujoco.__file__).parent.glob("*mujoco*"):
        if path.suffix in (".dylib", ".dll") or ".so" in path.suffixes:
            return ctypes.CDLL(str(path))
    raise InputError(f"MuJoCo's library is not in {Path(mujoco.__file__).parent}; install the package 'mujoco' again")


def _collide(find: Callable[..., int], other: Any, where: _Addresses) -> Callable[..., int]:
    """A collision function: `find` for marked geoms, else MuJoCo's own."""
    word = ctypes.c_size_t.from_address
    whole = ctypes.c_int.from_address

    def collide(model: int, data: int, contacts: int, first: int, second: int, margin: float) -> int:
        kinds = word(model + where.contype).value
        a = whole(kinds + 4 * first).value & MARK
        b = whole(kinds + 4 * second).value & MARK
        found = -1
        if a != b:
            ground, sole, sign = (first, second, 1.0) if a else (second, first, -1.0)
            arrays = word(data + where.places).value, word(data + where.turns).value, word(model + where.sizes).value
            found = find(*arrays, ground, sole, margin, contacts, sign)
        return found if found >= 0 else int(other(model, data, contacts, first, second, margin))

    return collide
