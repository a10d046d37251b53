"""A universal Mach-O file: the same library for several processors in one file.

FMI's darwin64 means x86-64, but importers on Apple silicon look there too. A universal library serves both.
"""

import struct

MAGIC = 0xCAFEBABE
PAGE_BITS = 14  # pages of 16 KiB on ARM


def universal(slices: list[bytes]) -> bytes:
    """The universal file of thin 64-bit libraries; they are not changed, so signatures stay valid."""
    page = 1 << PAGE_BITS
    header = struct.pack(">II", MAGIC, len(slices))
    body = b""
    for content in slices:
        processor, model = struct.unpack_from("<ii", content, 4)
        offset = -(-(page + len(body)) // page) * page
        header += struct.pack(">iiIII", processor, model, offset, len(content), PAGE_BITS)
        body += b"\0" * (offset - page - len(body)) + content
    return header.ljust(page, b"\0") + body
