"""Writes scenes of named faces in the formats of analysis programs: each format as its own manual
says, with numbers of 17 digits so that all of them are the same scene."""

import base64
import struct
import zlib

import numpy


class Mesh:
    """Triangles and quadrilaterals over points, in groups with names."""

    def __init__(self, points, groups):
        self.points = [tuple(map(float, p)) for p in points]
        self.groups = groups  # {name: [corners, ...]}, corners counted from 0

    def faces(self):
        return [(number, corners) for number, faces in enumerate(self.groups.values(), 1)
                for corners in faces]


def from_obj(path):
    """Points, and faces by their materials; no more than triangles and quadrilaterals."""
    points, groups, name = [], {}, None
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append(words[1:4])
        elif words[:1] == ["usemtl"]:
            name = words[1]
        elif words[:1] == ["f"]:
            groups.setdefault(name, []).append([int(w.split("/")[0]) - 1 for w in words[1:]])
    return Mesh(points, groups)


def to_obj(mesh):
    text = "".join("v {!r} {!r} {!r}\n".format(*p) for p in mesh.points)
    for name, faces in mesh.groups.items():
        text += f"o {name}\n" + "".join(f"f {' '.join(str(c + 1) for c in f)}\n" for f in faces)
    return text.encode()


def to_view3d(mesh):
    text = "F 3\n" + "".join("V {} {!r} {!r} {!r}\n".format(k + 1, *p) for k, p in enumerate(mesh.points))
    names, first, number = list(mesh.groups), {}, 0
    for group, corners in mesh.faces():
        number += 1
        four = [c + 1 for c in corners] + [0] * (4 - len(corners))
        combined = first.setdefault(group, number)
        text += "S {} {} {} {} {} 0 {} .5 {}\n".format(number, *four, combined if combined < number else 0,
                                                       names[group - 1])
    return (text + "End\n").encode()


def gmsh_names(mesh):
    return f"$PhysicalNames\n{len(mesh.groups)}\n" + "".join(
        f'2 {k} "{name}"\n' for k, name in enumerate(mesh.groups, 1)) + "$EndPhysicalNames\n"


def to_gmsh2(mesh, binary=False):
    faces = mesh.faces()
    head = f"$MeshFormat\n2.2 {int(binary)} 8\n".encode()
    names = gmsh_names(mesh).encode()
    if not binary:
        text = "$EndMeshFormat\n" + names.decode() + f"$Nodes\n{len(mesh.points)}\n"
        text += "".join("{} {!r} {!r} {!r}\n".format(10 * k + 7, *p) for k, p in enumerate(mesh.points))
        text += f"$EndNodes\n$Elements\n{len(faces)}\n"
        for k, (group, corners) in enumerate(faces):
            text += f"{k + 1} {len(corners) - 1} 2 {group} 1 {' '.join(str(10 * c + 7) for c in corners)}\n"
        return head + (text + "$EndElements\n").encode()
    data = head + struct.pack("<i", 1) + b"\n$EndMeshFormat\n" + names
    data += f"$Nodes\n{len(mesh.points)}\n".encode()
    data += b"".join(struct.pack("<i3d", 10 * k + 7, *p) for k, p in enumerate(mesh.points))
    data += f"\n$EndNodes\n$Elements\n{len(faces)}\n".encode()
    for k, (group, corners) in enumerate(faces):
        data += struct.pack(f"<{6 + len(corners)}i", len(corners) - 1, 1, 2, k + 1, group, 1,
                            *(10 * c + 7 for c in corners))
    return data + b"\n$EndElements\n"


def to_gmsh4(mesh, binary=False):
    """Each group is a physical group of one entity."""
    def pack(kinds, *numbers):
        if binary:
            return struct.pack("<" + kinds, *numbers)
        return (" ".join(map(repr, numbers)) + "\n").encode()
    end = b"\n" if binary else b""
    data = f"$MeshFormat\n4.1 {int(binary)} 8\n".encode() + (struct.pack("<i", 1) + b"\n" if binary else b"")
    data += b"$EndMeshFormat\n" + gmsh_names(mesh).encode()
    data += b"$Entities\n" + pack("4Q", 0, 0, len(mesh.groups), 0)
    for k in range(1, len(mesh.groups) + 1):
        data += pack("i6dQiQ", k + 100, 0., 0., 0., 1., 1., 1., 1, k, 0)
    data += end + b"$EndEntities\n$Nodes\n" + pack("4Q", 1, len(mesh.points), 7, 10 * len(mesh.points))
    data += pack("3iQ", 2, 101, 0, len(mesh.points))
    data += b"".join(pack("Q", 10 * k + 7) for k in range(len(mesh.points)))
    data += b"".join(pack("3d", *p) for p in mesh.points)
    blocks = [(k, size, [f for f in faces if len(f) == size])
              for k, faces in enumerate(mesh.groups.values(), 1) for size in (3, 4)]
    blocks = [b for b in blocks if b[2]]
    data += end + b"$EndNodes\n$Elements\n" + pack("4Q", len(blocks), len(mesh.faces()), 1, len(mesh.faces()))
    number = 0
    for k, size, faces in blocks:
        data += pack("3iQ", 2, k + 100, size - 1, len(faces))
        for corners in faces:
            number += 1
            data += pack(f"{size + 1}Q", number, *(10 * c + 7 for c in corners))
    return data + end + b"$EndElements\n"


def to_inp(mesh):
    text = "*HEADING\na scene\n*NODE, NSET=Nall\n"
    text += "".join("{}, {!r}, {!r}, {!r}\n".format(10 * k + 7, *p) for k, p in enumerate(mesh.points))
    for number, (group, corners) in enumerate(mesh.faces(), 1):
        name = list(mesh.groups)[group - 1]
        text += f"*ELEMENT, TYPE=S{len(corners)}, ELSET={name}\n{number}, "
        text += ", ".join(str(10 * c + 7) for c in corners) + "\n"
    return (text + "*ELSET, ELSET=Eall, GENERATE\n1, 99999\n").encode()


def to_ply(mesh, encoding):
    """`encoding`: ascii, binary_little_endian or binary_big_endian."""
    head = (f"ply\nformat {encoding} 1.0\ncomment made by a test\nelement vertex {len(mesh.points)}\n"
            "property double x\nproperty double y\nproperty double z\n"
            f"element face {len(mesh.faces())}\nproperty list uchar int vertex_indices\n"
            "property int group\nend_header\n").encode()
    if encoding == "ascii":
        text = "".join("{!r} {!r} {!r}\n".format(*p) for p in mesh.points)
        text += "".join(f"{len(c)} {' '.join(map(str, c))} {g}\n" for g, c in mesh.faces())
        return head + text.encode()
    order = "<" if "little" in encoding else ">"
    data = b"".join(struct.pack(order + "3d", *p) for p in mesh.points)
    data += b"".join(struct.pack(f"{order}B{len(c) + 1}i", len(c), *c, g) for g, c in mesh.faces())
    return head + data


def to_vtk(mesh, binary=False, dataset="POLYDATA", version="3.0"):
    """Legacy VTK with an array `group` of cells."""
    faces = [c for _, c in mesh.faces()]
    def numbers(kind, values):
        if binary:
            return struct.pack(f">{len(values)}{kind}", *values) + b"\n"
        return (" ".join(map(repr, values)) + "\n").encode()
    data = f"# vtk DataFile Version {version}\na scene\n{'BINARY' if binary else 'ASCII'}\n".encode()
    data += f"DATASET {dataset}\nPOINTS {len(mesh.points)} double\n".encode()
    data += numbers("d", [x for p in mesh.points for x in p])
    word = "POLYGONS" if dataset == "POLYDATA" else "CELLS"
    flat = [c for f in faces for c in f]
    if version == "5.1":
        offsets = [0]
        for face in faces:
            offsets.append(offsets[-1] + len(face))
        data += f"{word} {len(offsets)} {len(flat)}\nOFFSETS vtktypeint64\n".encode() + numbers("q", offsets)
        data += b"CONNECTIVITY vtktypeint64\n" + numbers("q", flat)
    else:
        data += f"{word} {len(faces)} {len(flat) + len(faces)}\n".encode()
        data += numbers("i", [n for f in faces for n in [len(f), *f]])
    if dataset != "POLYDATA":
        data += f"CELL_TYPES {len(faces)}\n".encode()
        data += numbers("i", [{3: 5, 4: 9}.get(len(f), 7) for f in faces])
    data += f"CELL_DATA {len(faces)}\nSCALARS group int 1\nLOOKUP_TABLE default\n".encode()
    return data + numbers("i", [g for g, _ in mesh.faces()])


def to_vtk_xml(mesh, kind="PolyData", form="ascii", compressed=False, header="UInt64", encoding="base64"):
    """.vtp (PolyData) or .vtu (UnstructuredGrid); form: ascii, binary (inline) or appended."""
    faces = [c for _, c in mesh.faces()]
    flat = numpy.array([c for f in faces for c in f], "<i8")
    offsets = numpy.cumsum([len(f) for f in faces]).astype("<i8")
    appended = b""
    width = {"UInt32": "<I", "UInt64": "<Q"}[header]

    def block(raw):
        """Header and data as they stand in the file, before base64."""
        if not compressed:
            return struct.pack(width, len(raw)), raw
        size = 1000
        parts = [raw[k:k + size] for k in range(0, len(raw), size)] or [b""]
        packed = [zlib.compress(p) for p in parts]
        rest = len(parts[-1]) % size
        head = [len(parts), size, rest, *map(len, packed)]
        return b"".join(struct.pack(width, n) for n in head), b"".join(packed)

    def array(kind, name, values, components=1):
        nonlocal appended
        start = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '
        if form == "ascii":
            return start + 'format="ascii">' + " ".join(map(repr, values.tolist())) + "</DataArray>\n"
        head, body = block(values.tobytes())
        if encoding == "raw":
            coded = head + body
        elif compressed:  # header and data are coded apart
            coded = base64.b64encode(head) + base64.b64encode(body)
        else:
            coded = base64.b64encode(head + body)
        if form == "binary":
            return start + f'format="binary">\n {coded.decode()}\n</DataArray>\n'
        offset = len(appended)
        appended += coded
        return start + f'format="appended" offset="{offset}"/>\n'

    points = array("Float64", "Points", numpy.array(mesh.points, "<f8").ravel(), 3)
    connectivity = array("Int64", "connectivity", flat) + array("Int64", "offsets", offsets)
    groups = array("Int32", "group", numpy.array([g for g, _ in mesh.faces()], "<i4"))
    text = '<?xml version="1.0"?>\n'
    text += f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="{header}"'
    text += ' compressor="vtkZLibDataCompressor">' if compressed else ">"
    polys = f'NumberOfPoints="{len(mesh.points)}" '
    if kind == "PolyData":
        text += f'<PolyData><Piece {polys}NumberOfPolys="{len(faces)}"><Points>{points}</Points>'
        text += f"<Polys>{connectivity}</Polys>"
    else:
        types = array("UInt8", "types", numpy.array([{3: 5, 4: 9}.get(len(f), 7) for f in faces], "u1"))
        text += f'<UnstructuredGrid><Piece {polys}NumberOfCells="{len(faces)}"><Points>{points}</Points>'
        text += f"<Cells>{connectivity}{types}</Cells>"
    text += f"<CellData>{groups}</CellData></Piece></{kind}>\n"
    data = text.encode()
    if appended:
        data += f'<AppendedData encoding="{encoding}">_'.encode() + appended + b"</AppendedData>\n"
    return data + b"</VTKFile>\n"
