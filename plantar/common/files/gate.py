"""Limits for foreign files, and the libraries that read them apart.

SECURITY.md is made of these declarations (`tools/security_page.py`).
"""

import os
from collections.abc import Mapping
from typing import Any, NamedTuple

from numpy.typing import NDArray

from plantar.common.files.confined import confined
from plantar.common.files.input_file import check_input
from plantar.common.files.structured_text import JSON_MOST, TOML_MOST
from plantar.common.files.text_table import TABLE_MOST
from plantar.common.files.xml_file import XML_MOST
from plantar.errors import PlantarError

SIZES: Mapping[str, float] = {
    "TOML: robots, scenes, parameters": TOML_MOST,
    "JSON: layouts, parameters, outlines": JSON_MOST,
    "XML: models, drawings, sheets": XML_MOST,
    "tables of events and participants": TABLE_MOST,
}
"""Largest file in bytes of each kind that is read whole in Plantar's own process."""


_MESHES = "plantar.shoes.foot.library_files"
_TRIMESH = "plantar.common.files.mesh_library"


class Helper(NamedTuple):
    """Library that reads a file kind in a separate process.

    `function`: called there, "package.module:name"; `memory`: allowed bytes: some, and more for each byte of the file;
    `seconds`: processor time in s, likewise.
    """

    function: str
    what: str
    memory: tuple[float, float]
    seconds: tuple[float, float]
    library: str


HELPERS: Mapping[str, Helper] = {
    "model": Helper(
        "plantar.common.files.model_limits:parsed_in_trial",
        "a robot's model",
        (1e9, 0.0),
        (10.0, 0.0),
        "MuJoCo, at first",
    ),
    "image": Helper(
        "plantar.formats.footprint_image:decoded_image", "an image", (1.5e9, 0.0), (20.0, 0.0), "OpenCV's decoder"
    ),
    "c3d": Helper("plantar.formats.c3d_content:content_of_file", "a C3D file", (250e6, 64.0), (10.0, 3e-6), "ezc3d"),
    "bag": Helper("plantar.formats.ros_bag:series_of_bag", "a ROS bag", (300e6, 30.0), (10.0, 2e-6), "rosbags"),
    "xls": Helper("plantar.formats.excel_sheet:text_of_workbook", "a workbook", (300e6, 60.0), (5.0, 3e-6), "xlrd"),
    "dxf": Helper(f"{_MESHES}:lines_of_dxf", "a DXF drawing", (300e6, 20.0), (3.0, 0.25e-6), "ezdxf"),
    "ply": Helper(f"{_TRIMESH}:triangles_of_trimesh", "a PLY mesh", (330e6, 20.0), (2.5, 2.5e-7), "trimesh"),
    "off": Helper(f"{_TRIMESH}:triangles_of_trimesh", "a OFF mesh", (330e6, 20.0), (2.5, 2.5e-7), "trimesh"),
    "dae": Helper(f"{_TRIMESH}:triangles_of_trimesh", "a DAE mesh", (330e6, 20.0), (30.0, 2e-6), "pycollada"),
    "meshes": Helper(f"{_TRIMESH}:triangles_of_listed", "meshes", (330e6, 20.0), (30.0, 2e-6), "trimesh"),
    "iges": Helper(f"{_MESHES}:triangles_of_step", "a IGES mesh", (330e6, 30.0), (3.0, 1e-6), "OpenCascade"),
    "step": Helper(f"{_MESHES}:triangles_of_step", "a STEP mesh", (330e6, 30.0), (3.0, 1e-6), "OpenCascade"),
}
"""How each kind of file is read apart."""


def read_apart(
    kind: str, path: str | os.PathLike[str], error: type[PlantarError], size: int | None = None
) -> dict[str, NDArray[Any]]:
    """Returns arrays of the file at `path`, read in a separate process by the helper of a `kind` of HELPERS.

    Raises `error` if unreadable, or reading crashes or passes a limit; `size` is a folder's in bytes, None for a file.

    Example:
        >>> read_apart("image", "/dev/zero", PlantarError)
        Traceback (most recent call last):
        plantar.errors.PlantarError: /dev/zero: cannot be read (it is a device); allowed: a regular file
    """
    helper = HELPERS[kind]
    count = check_input(path, error) if size is None else size
    memory, seconds = (least + each * count for least, each in (helper.memory, helper.seconds))
    return confined(helper.function, path, error, helper.what, memory, seconds)


PROMISES: Mapping[str, str] = {
    "No file makes Plantar run code: pickled arrays are refused.": "tests/plantar/formats/test_tables_and_arrays.py",
    "A file is refused in one line, within 5 s and 500 MB.": "tests/test_hostile_files.py",
    "A pipe, a device or a folder is not read.": "tests/plantar/common/files/test_input_file.py",
    "XML that declares entities, or is deeper or larger than a model, is not read.": (
        "tests/plantar/common/files/test_gate.py"
    ),
    "An archive is sized before it is unpacked.": "tests/plantar/common/files/test_zip_archive.py",
    "A model reads files of its folder and package alone, links followed.": (
        "tests/plantar/common/files/test_model_files.py"
    ),
    "A model of more parts than a robot's, or of tables of any size, is not made.": (
        "tests/plantar/common/files/test_gate.py"
    ),
    "Native readers run in a separate process, with limits of memory and time.": (
        "tests/plantar/common/files/test_gate.py"
    ),
    "A message of a recording that is damaged is left out and counted.": "tests/plantar/viewer/test_walk.py",
    "No cell of a written table is a formula.": "tests/plantar/common/test_table_writer.py",
    "No text of a file moves the terminal's cursor.": "tests/plantar/common/console/test_ending.py",
    "A page runs only its own scripts and makes no request.": "tests/plantar/common/pages/test_page.py",
    "A Dask scheduler is trusted by certificates, or on this machine alone without a note.": (
        "tests/plantar/common/workers/test_cluster_workers.py"
    ),
    "No random damage of a file traces back, hangs or takes memory without bound.": "tests/fuzz/test_mutants.py",
}
"""What is promised, and the test that fails where it is broken."""
