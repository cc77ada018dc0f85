"""Stated size of an image, before decoding."""

import struct
from dataclasses import dataclass

_PNG = b"\x89PNG\r\n\x1a\n"
_JPEG = b"\xff\xd8"
_PNG_CHANNELS = {0: 1, 2: 3, 3: 3, 4: 2, 6: 4}
_NO_FRAME = (0xC4, 0xC8, 0xCC)  # JPEG markers among those of a frame that are none
_ALONE = (0x01, *range(0xD0, 0xD8))  # JPEG markers without a length
_MOST_TAGS = 4096
_TIFF_NUMBER = {1: "B", 3: "H", 4: "I"}


@dataclass(frozen=True)
class ImageSize:
    """Size of an image. `depth`: decoded bytes a pixel."""

    width: int
    height: int
    depth: int

    @property
    def memory(self) -> int:
        """Bytes of the decoded image."""
        return self.width * self.height * self.depth


def stated_size(data: bytes) -> ImageSize | None:
    """Size in the bytes of a PNG, JPEG, TIFF or BMP; None for others, and if cut short.

    Example:
        >>> stated_size(b"BM" + bytes(12) + struct.pack("<IiiHH", 40, 30, -20, 1, 24) + bytes(20))
        ImageSize(width=30, height=20, depth=3)
        >>> stated_size(b"text")
    """
    try:
        if data.startswith(_PNG):
            width, height, bits, kind = struct.unpack_from(">IIBB", data, 16)
            return ImageSize(width, height, _PNG_CHANNELS.get(kind, 4) * max(1, bits // 8))
        if data.startswith(_JPEG):
            return _of_jpeg(data)
        if data.startswith((b"II*\0", b"MM\0*")):
            return _of_tiff(data)
        if data.startswith(b"BM"):
            return _of_bmp(data)
    except struct.error:
        return None
    return None


def _of_jpeg(data: bytes) -> ImageSize | None:
    at = 2
    while at + 4 <= len(data):
        if data[at] != 0xFF:
            return None
        marker = data[at + 1]
        if marker == 0xFF or marker in _ALONE:
            at += 1 if marker == 0xFF else 2
            continue
        if 0xC0 <= marker <= 0xCF and marker not in _NO_FRAME:
            bits, height, width, channels = struct.unpack_from(">BHHB", data, at + 4)
            return ImageSize(width, height, channels * (1 if bits <= 8 else 2))
        at += 2 + struct.unpack_from(">H", data, at + 2)[0]
    return None


def _of_bmp(data: bytes) -> ImageSize:
    (header,) = struct.unpack_from("<I", data, 14)
    if header == 12:
        width, height, _, bits = struct.unpack_from("<HHHH", data, 18)
    else:
        width, height, _, bits = struct.unpack_from("<iiHH", data, 18)
    return ImageSize(abs(width), abs(height), 4 if bits == 32 else 3)


def _of_tiff(data: bytes) -> ImageSize | None:
    order = "<" if data.startswith(b"II") else ">"
    (start,) = struct.unpack_from(f"{order}I", data, 4)
    (count,) = struct.unpack_from(f"{order}H", data, start)
    tags: dict[int, int] = {}
    for at in range(start + 2, start + 2 + 12 * min(count, _MOST_TAGS), 12):
        tag, kind, values = struct.unpack_from(f"{order}HHI", data, at)
        number = _TIFF_NUMBER.get(kind)
        if number is None:
            continue
        place = at + 8
        if values * struct.calcsize(number) > 4:  # the values stand elsewhere
            (place,) = struct.unpack_from(f"{order}I", data, at + 8)
        tags[tag] = struct.unpack_from(f"{order}{number}", data, place)[0]
    if 256 not in tags or 257 not in tags:
        return None
    return ImageSize(tags[256], tags[257], max(3, tags.get(277, 1)) * max(1, tags.get(258, 1) // 8))
