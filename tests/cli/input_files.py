"""Makes small scene files in memory, sound ones that a test then breaks."""

import json
import struct
import zlib


def glb(document, binary=b"", text=None):
    """A .glb of a JSON document (or of `text` as it stands) and the bytes of its buffer."""
    body = (text if text is not None else json.dumps(document)).encode()
    body += b" " * (-len(body) % 4)
    chunks = struct.pack("<II", len(body), 0x4E4F534A) + body
    if binary:
        binary += b"\0" * (-len(binary) % 4)
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


TRIANGLE_DATA = struct.pack("<9f3H", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 2) + b"\0\0"
UV_DATA = struct.pack("<6f", 0, 0, 1, 0, 0, 1)


def triangle():
    """The document of a glTF with one textured triangle; its buffer is triangle_data()."""
    return {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "plate"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1,
                                    "material": 0}]}],
        "materials": [{"name": "paint", "pbrMetallicRoughness": {"metallicFactor": 0,
                                                                  "baseColorFactor": [.5, .5, .5, 1]}}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
            {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"},
        ],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                        {"buffer": 0, "byteOffset": 36, "byteLength": 6},
                        {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
        "buffers": [{"byteLength": 68}],
    }


def triangle_data():
    return TRIANGLE_DATA + UV_DATA


def with_image(document, data, image):
    """Adds an image to the document and its buffer, as the texture of the first material."""
    document["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(image)})
    document["buffers"][0]["byteLength"] = len(data) + len(image)
    document["images"] = [{"bufferView": len(document["bufferViews"]) - 1, "mimeType": "image/png",
                           "name": "picture"}]
    document["textures"] = [{"source": 0}]
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
    return data + image


def png(width, height, rows=None):
    """A grey PNG that claims this size; `rows` rows of it are there (all by default)."""
    def chunk(kind, content):
        return (struct.pack(">I", len(content)) + kind + content
                + struct.pack(">I", zlib.crc32(kind + content)))
    lines = (b"\0" + b"\x80" * width) * (height if rows is None else rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


def bmp(width, height):
    return (struct.pack("<2sIHHI", b"BM", 58, 0, 0, 54)
            + struct.pack("<IiiHHIIiiII", 40, width, height, 1, 24, 0, 4, 0, 0, 0, 0) + b"\0" * 4)


def gif(width, height):
    return b"GIF89a" + struct.pack("<HHBBB", width, height, 0x80, 0, 0) + b"\0\0\0\xff\xff\xff;"


def psd(width, height):
    return struct.pack(">4sH6xHIIHH", b"8BPS", 1, 3, height, width, 8, 3) + b"\0" * 40


def webp(width, height):
    canvas = struct.pack("<I", 0x10) + (width - 1).to_bytes(3, "little") + (height - 1).to_bytes(3, "little")
    body = b"WEBPVP8X" + struct.pack("<I", 10) + canvas
    return b"RIFF" + struct.pack("<I", len(body)) + body


def ascii_stl(name="plate", triangles=1):
    facet = ("  facet normal 0 0 1\n    outer loop\n      vertex {0} 0 0\n      vertex {1} 0 0\n"
             "      vertex {0} 1 0\n    endloop\n  endfacet\n")
    return (f"solid {name}\n" + "".join(facet.format(k, k + 1) for k in range(triangles))
            + f"endsolid {name}\n")


def binary_stl(triangles=1, header=b"made by hand", claimed=None):
    records = b"".join(struct.pack("<12fH", 0, 0, 1, k, 0, 0, k + 1, 0, 0, k, 1, 0, 0)
                       for k in range(triangles))
    count = triangles if claimed is None else claimed
    return header.ljust(80) + struct.pack("<I", count) + records


PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 1
property list uchar int vertex_indices
end_header
0 0 0 255 255 255
1 0 0 255 255 255
0 1 0 255 255 255
3 0 1 2
"""
