"""Faces by object and material, written as OBJ with MTL or as glTF, as exporters write them."""

import base64
import json
from pathlib import Path

import numpy as np

# Kd, Ke of all materials here.
MATERIALS = {
    "plain": ((0.6, 0.6, 0.6), (0, 0, 0)),
    "dark": ((0.2, 0.2, 0.25), (0, 0, 0)),
    "red": ((0.6, 0.2, 0.1), (0, 0, 0)),
    "green": ((0.15, 0.45, 0.1), (0, 0, 0)),
    "lamp": ((0.5, 0.5, 0.5), (8, 8, 7)),
}


def polygon_area(corners):
    """Least and most: of a quad that is not planar it depends on the diagonal it is cut along."""
    def triangles(turned):
        return 0.5 * np.cross(turned[1:-1] - turned[0], turned[2:] - turned[0])

    if len(corners) > 4:  # planar in all scenes, but maybe concave
        area = np.linalg.norm(triangles(corners).sum(axis=0))
        return area, area
    both = [np.linalg.norm(triangles(turned), axis=1).sum()
            for turned in (corners, np.roll(corners, 1, axis=0))]
    return min(both), max(both)


class SceneText:
    """Contents of a file. Faces are lists of corners; `share` merges equal corners of one object,
    as modellers do; without it every face has corners of its own, as scanners and CAD kernels do."""

    def __init__(self, share=True, digits=9):
        self.share = share
        self.digits = digits
        self.vertices = []
        self.groups = []  # (object, material, faces as lists of indices)
        self.known = {}

    def group(self, name, material="plain"):
        self.groups.append((name, material, []))
        self.known = {}
        return self

    def vertex(self, point):
        point = tuple(float(x) for x in point)
        if self.share and point in self.known:
            return self.known[point]
        self.vertices.append(point)
        self.known[point] = len(self.vertices) - 1
        return len(self.vertices) - 1

    def face(self, *corners):
        self.groups[-1][2].append([self.vertex(p) for p in corners])

    def box(self, low, high, inward=False):
        """Six quads, normals outward or inward."""
        x, y, z = zip(low, high)
        c = [(x[i & 1], y[i >> 1 & 1], z[i >> 2]) for i in range(8)]
        for quad in ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1),
                     (4, 5, 7, 6)):
            self.face(*(c[k] for k in (reversed(quad) if inward else quad)))

    def lamp(self, centre, side):
        """A square that shines down (-z)."""
        x, y, z = centre
        h = side / 2
        self.group("lamp", "lamp")
        self.face((x - h, y - h, z), (x - h, y + h, z), (x + h, y + h, z), (x + h, y - h, z))

    def face_count(self):
        return sum(len(faces) for _, _, faces in self.groups)

    def area(self):
        """Least and most that a reader of the file gets."""
        points = np.array([[float(f"{x:.{self.digits}g}") for x in p] for p in self.vertices])
        return np.sum([polygon_area(points[face]) for _, _, faces in self.groups
                       for face in faces], axis=0)

    def write(self, path):
        """PATH.obj and PATH.mtl."""
        path = Path(path)
        number = f"%.{self.digits}g"
        lines = [f"mtllib {path.stem}.mtl"]
        lines += [f"v {number} {number} {number}" % p for p in self.vertices]
        for name, material, faces in self.groups:
            lines += [f"o {name}", f"usemtl {material}"]
            lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
        path.with_suffix(".obj").write_text("\n".join(lines) + "\n")
        used = sorted({material for _, material, _ in self.groups})
        path.with_suffix(".mtl").write_text("".join(
            "newmtl {}\nKd {} {} {}\nKe {} {} {}\n".format(m, *MATERIALS[m][0], *MATERIALS[m][1])
            for m in used))
        return path.with_suffix(".obj")


class LinkedScene:
    """One mesh a group of a SceneText, and nodes that show it, each with a matrix of its own."""

    def __init__(self, parts):
        self.parts = parts
        self.nodes = []  # (name, group, 4 x 4 matrix)

    def node(self, name, group, matrix):
        self.nodes.append((name, group, np.asarray(matrix, dtype=float)))

    def face_count(self):
        return sum(len(self.triangles(group)) for _, group, _ in self.nodes)

    def triangles(self, group):
        """Of a group: corners as float32, as glTF keeps them."""
        points = np.array(self.parts.vertices, dtype=np.float32)
        return np.array([points[[f[0], f[k], f[k + 1]]] for f in self.parts.groups[group][2]
                         for k in range(1, len(f) - 1)])

    def area(self):
        """Least and most that a reader of the file gets."""
        total = 0.0
        for _, group, matrix in self.nodes:
            points = self.triangles(group).astype(float) @ matrix[:3, :3].T
            total += sum(polygon_area(triangle)[0] for triangle in points)
        return total, total

    def write(self, path):
        """PATH.gltf with its buffer inside."""
        path = Path(path).with_suffix(".gltf")
        buffer = bytearray()
        gltf = {"asset": {"version": "2.0"}, "scene": 0, "buffers": [], "bufferViews": [],
                "accessors": [], "meshes": [], "materials": [], "nodes": []}
        names = list(MATERIALS)
        for name in names:
            colour, light = MATERIALS[name]
            strength = max(light)
            material = {"name": name, "doubleSided": strength == 0, "pbrMetallicRoughness":
                        {"baseColorFactor": [*colour, 1], "metallicFactor": 0}}
            if strength > 0:
                material["emissiveFactor"] = [x / strength for x in light]
                material["extensions"] = {
                    "KHR_materials_emissive_strength": {"emissiveStrength": strength}}
            gltf["materials"].append(material)
        gltf["extensionsUsed"] = ["KHR_materials_emissive_strength"]
        for g, (name, material, _) in enumerate(self.parts.groups):
            points = self.triangles(g).reshape(-1, 3)
            gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(buffer),
                                        "byteLength": points.nbytes})
            buffer += points.tobytes()
            gltf["accessors"].append({"bufferView": g, "componentType": 5126, "type": "VEC3",
                                      "count": len(points), "min": points.min(0).tolist(),
                                      "max": points.max(0).tolist()})
            gltf["meshes"].append({"name": name, "primitives": [
                {"attributes": {"POSITION": g}, "material": names.index(material)}]})
        for name, group, matrix in self.nodes:
            gltf["nodes"].append({"name": name, "mesh": group,
                                  "matrix": matrix.T.ravel().tolist()})
        gltf["scenes"] = [{"nodes": list(range(len(self.nodes)))}]
        data = base64.b64encode(bytes(buffer)).decode()
        gltf["buffers"].append({"byteLength": len(buffer),
                                "uri": "data:application/octet-stream;base64," + data})
        path.write_text(json.dumps(gltf))
        return path

