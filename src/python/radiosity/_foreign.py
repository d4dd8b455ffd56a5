"""Scenes of meshio and trimesh, which read 40 formats between them. Neither is imported: what they
made is looked at."""

from __future__ import annotations

from typing import Any, Mapping, Optional

import numpy as np

from ._core import InputError
from ._scene import Scene

#: meshio's cells that are faces, and how many of their points are corners
_FACES = {"triangle": 3, "triangle6": 3, "triangle7": 3, "quad": 4, "quad8": 4, "quad9": 4}


def from_meshio(mesh: Any, materials: Optional[Mapping[Any, Mapping[str, Any]]] = None,
                sky: Any = 0.0) -> Scene:
    """A scene of a meshio.Mesh: its triangles, quadrilaterals and polygons, as Scene() takes them.

    Groups are its cell sets, else its physical groups (gmsh), else one. A face of no set is in the
    group "other". Volumes, lines and points are left out. All arrays are copied.

    Errors: InputError for a mesh without faces.

    >>> import meshio
    >>> square = meshio.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    ...                      [("quad", [[0, 1, 2, 3]])], cell_sets={"floor": [[0]]})
    >>> rad.from_meshio(square).surface_names
    ['floor']
    """
    if not hasattr(mesh, "cells") or not hasattr(mesh, "points"):
        raise InputError(f"mesh: is of type {type(mesh).__name__}; give a meshio.Mesh")
    points = np.asarray(mesh.points, dtype=np.float64)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    faces: list = []
    groups: list = []
    for number, block in enumerate(mesh.cells):
        size = _FACES.get(block.type, 0)
        if block.type != "polygon" and not size:
            continue
        data = [face if not size else face[:size] for face in block.data]
        faces.extend(data)
        groups.extend(_groups(mesh, number, len(data)))
    if not faces:
        kinds = ", ".join(sorted({block.type for block in mesh.cells})) or "no cells"
        raise InputError(f"meshio mesh: has no faces but {kinds}; extract its surface first")
    if len({len(face) for face in faces}) == 1:
        return Scene(points, np.asarray(faces), groups, materials, sky)
    return Scene(points, faces, groups, materials, sky)


def _groups(mesh: Any, block: int, count: int) -> list:
    """A name a cell of one block."""
    sets = {name: cells[block] for name, cells in (mesh.cell_sets or {}).items()
            if not name.startswith("gmsh:") and cells[block] is not None}
    if sets:
        names = ["other"] * count
        for name, cells in sets.items():
            for cell in np.asarray(cells, dtype=np.int64).reshape(-1):
                names[cell] = name
        return names
    tags = (mesh.cell_data or {}).get("gmsh:physical")
    if tags is None:
        return ["surface"] * count
    named = {int(value[0]): name for name, value in (mesh.field_data or {}).items()}
    return [named.get(int(tag), f"physical {tag}") for tag in tags[block]]


def from_trimesh(mesh: Any, materials: Optional[Mapping[Any, Mapping[str, Any]]] = None,
                 sky: Any = 0.0) -> Scene:
    """A scene of a trimesh.Trimesh, one group, or of a trimesh.Scene, whose geometries are groups in
    the place where its graph puts them. All arrays are copied.

    Errors: InputError for one without faces.
    """
    if not hasattr(mesh, "geometry") and not hasattr(mesh, "faces"):
        raise InputError(f"mesh: is of type {type(mesh).__name__}; give a trimesh.Trimesh or Scene")
    if hasattr(mesh, "geometry"):
        parts = []
        for node in mesh.graph.nodes_geometry:
            transform, name = mesh.graph[node]
            part = mesh.geometry[name].copy()
            part.apply_transform(transform)
            parts.append((str(node), part))
    else:
        parts = [("surface", mesh)]
    parts = [(name, part) for name, part in parts if len(getattr(part, "faces", ()))]
    if not parts:
        raise InputError("trimesh: has no faces; give a Trimesh, or a Scene of some")
    first = np.cumsum([0] + [len(part.vertices) for _, part in parts])
    return Scene(np.concatenate([np.asarray(part.vertices) for _, part in parts]),
                 np.concatenate([np.asarray(part.faces) + k for k, (_, part) in zip(first, parts)]),
                 np.repeat([name for name, _ in parts], [len(part.faces) for _, part in parts]),
                 materials, sky)
