"""Write the descriptors of Foxglove's schemas that recordings carry: `python tools/foxglove_schemas.py`.

They come from the package foxglove-schemas-protobuf (MIT licence); the tests compare them with it.
"""

from importlib import import_module
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parent.parent / "plantar" / "recordings" / "schemas"


def descriptor_set(schema: str) -> bytes:
    """A schema's FileDescriptorSet, each file after those that it needs.

    Args:
        schema: Its full name, such as "foxglove.Log".
    """
    from google.protobuf.descriptor_pb2 import FileDescriptorSet

    name = schema.removeprefix("foxglove.")
    message = getattr(import_module(f"foxglove_schemas_protobuf.{name}_pb2"), name)
    found = FileDescriptorSet()
    seen: set[str] = set()

    def add(file: Any) -> None:
        if file.name not in seen:
            seen.add(file.name)
            for needed in file.dependencies:
                add(needed)
            file.CopyToProto(found.file.add())

    add(message.DESCRIPTOR.file)
    return bytes(found.SerializeToString(deterministic=True))


def main() -> None:
    """Write all of them."""
    from plantar.recordings.foxglove import SCHEMAS

    FOLDER.mkdir(exist_ok=True)
    for schema in SCHEMAS:
        (FOLDER / f"{schema}.bin").write_bytes(descriptor_set(schema))


if __name__ == "__main__":
    main()
