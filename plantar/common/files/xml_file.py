"""Parses foreign XML, limited in size, depth and elements, without entities."""

from xml.etree import ElementTree

from plantar.errors import PlantarError

XML_MOST = 10_000_000
"""Largest XML file in bytes."""

_MOST_ELEMENTS = 200_000
_DEEPEST = 200


class _Limited(ElementTree.TreeBuilder):
    """Builds the tree until it is too large or too deep."""

    def __init__(self) -> None:
        super().__init__()
        self._count = 0
        self._depth = 0

    def start(self, tag: str, attrs: dict[str, str], /) -> ElementTree.Element:
        """Begin an element."""
        self._count += 1
        self._depth += 1
        if self._depth > _DEEPEST:
            raise ValueError(f"elements more than {_DEEPEST} deep in each other")
        if self._count > _MOST_ELEMENTS:
            raise ValueError(f"more than {_MOST_ELEMENTS} elements")
        return super().start(tag, attrs)

    def end(self, tag: str, /) -> ElementTree.Element:
        """End an element."""
        self._depth -= 1
        return super().end(tag)


def parse_xml(data: bytes, error: type[PlantarError], where: str) -> ElementTree.Element:
    """Returns outermost element of XML text `data`; raises `error`, its message beginning with `where`, for a bad one.

    Example:
        >>> parse_xml(b"<robot name='a'/>", PlantarError, "a.urdf").tag
        'robot'
        >>> parse_xml(b"<a>" * 1000, PlantarError, "a.urdf")
        Traceback (most recent call last):
        plantar.errors.PlantarError: a.urdf: not a readable XML file (elements more than 200 deep in each other)
    """
    if any("<!ENTITY".encode(encoding) in data for encoding in ("utf-8", "utf-16-le", "utf-16-be")):
        raise error(f"{where}: declares entities, which are not read; write out what they stand for")
    parser = ElementTree.XMLParser(target=_Limited())
    try:
        parser.feed(data)
        root = parser.close()
    except (ElementTree.ParseError, ValueError, LookupError) as problem:
        raise error(f"{where}: not a readable XML file ({problem})") from None
    assert isinstance(root, ElementTree.Element)
    return root
