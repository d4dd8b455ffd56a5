"""Reads an OpenEXR file without OpenEXR: float channels in scan lines, whole or packed by ZIP, and its texts
(openexr.com, "OpenEXR File Layout")."""

import struct
import zlib

import numpy as np

LINES_A_BLOCK = {0: 1, 2: 1, 3: 16}  # of compression none, ZIPS, ZIP


class ExrFile:
    """`channels`: name -> rows x columns; `texts`: the attributes that are strings."""

    def __init__(self, path):
        self.bytes = path.read_bytes()
        assert self.bytes[:4] == b"\x76\x2f\x31\x01"
        self.at = 8
        attributes = {}
        while name := self.word():
            kind, size = self.word(), self.number("<i")
            attributes[name] = (kind, self.bytes[self.at:self.at + size])
            self.at += size
        self.texts = {name: value.decode() for name, (kind, value) in attributes.items() if kind == "string"}
        left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"][1])
        self.width, self.height = right - left + 1, bottom - top + 1
        names = self.channel_names(attributes["channels"][1])
        compression = attributes["compression"][1][0]
        rows = np.empty((self.height, len(names), self.width), np.float32)
        step = LINES_A_BLOCK[compression]
        for first in range(0, self.height, step):
            offset = struct.unpack_from("<Q", self.bytes, self.at + first // step * 8)[0]
            y, size = struct.unpack_from("<ii", self.bytes, offset)
            count = min(step, self.height - first)
            block = self.unpacked(self.bytes[offset + 8:offset + 8 + size], 4 * count * len(names) * self.width)
            rows[y - top:y - top + count] = np.frombuffer(block, "<f4").reshape(count, len(names), self.width)
        self.channels = {name: rows[:, k] for k, name in enumerate(names)}

    def word(self):
        end = self.bytes.index(b"\0", self.at)
        text = self.bytes[self.at:end].decode()
        self.at = end + 1
        return text

    def number(self, form):
        value = struct.unpack_from(form, self.bytes, self.at)[0]
        self.at += struct.calcsize(form)
        return value

    @staticmethod
    def channel_names(text):
        names = []
        while text[0]:
            name, text = text.split(b"\0", 1)
            assert struct.unpack_from("<i", text)[0] == 2, "32-bit floats"
            names.append(name.decode())
            text = text[16:]
        return names

    @staticmethod
    def unpacked(data, size):
        """A block that would not get smaller is stored as it is; others are differences of bytes, the first
        bytes of pairs before the second ones."""
        if len(data) == size:
            return data
        steps = np.frombuffer(zlib.decompress(data), np.uint8).astype(np.int64)
        steps[1:] -= 128
        values = (np.cumsum(steps) & 255).astype(np.uint8)
        half = (size + 1) // 2
        out = np.empty(size, np.uint8)
        out[0::2], out[1::2] = values[:half], values[half:]
        return out.tobytes()


def write_exr(path, channels):
    """Writes float16 or float32 channels, by name (rows x columns each), as scan lines without packing."""
    names = sorted(channels)
    height, width = channels[names[0]].shape
    listed = b"".join(name.encode() + struct.pack("<xiiii", 1 if channels[name].dtype == np.float16 else 2, 0, 1, 1)
                      for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<Ii", 20000630, 2)
    for name, kind, value in (("channels", "chlist", listed), ("compression", "compression", b"\0"),
                              ("dataWindow", "box2i", window), ("displayWindow", "box2i", window),
                              ("lineOrder", "lineOrder", b"\0"), ("pixelAspectRatio", "float", struct.pack("<f", 1)),
                              ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
                              ("screenWindowWidth", "float", struct.pack("<f", 1))):
        head += name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    head += b"\0"
    lines = [b"".join(channels[name][y].tobytes() for name in names) for y in range(height)]
    size = len(lines[0]) + 8
    offsets = struct.pack(f"<{height}Q", *(len(head) + 8 * height + y * size for y in range(height)))
    path.write_bytes(head + offsets + b"".join(struct.pack("<ii", y, len(line)) + line for y, line in enumerate(lines)))
