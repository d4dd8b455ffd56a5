"""Scenes: from files, from arrays."""

from __future__ import annotations

import os
from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from . import _core
from ._arrays import Fixed, indices, numbers, path_text, printable, require, texts, yes_or_no
from ._core import InputError
from ._html import figure, summary, swatch
from ._notes import tell
from ._options import more, takes_options

#: The defaults of materials given as arrays.
_PLAIN = {"reflectance": 0.5, "emission": 0.0, "two_sided": False}


def _colour(name: str, value: Any) -> tuple:
    given = numbers(name, value, [(), (3,)], "one number, or red, green and blue")
    return tuple(float(x) for x in np.broadcast_to(given, 3))


def _faces_of(faces: Any) -> list:
    """A list of sequences of corners."""
    try:
        given = list(faces)
    except TypeError:
        raise InputError(f"faces: is of type {type(faces).__name__}; give (F, 3), (F, 4) or a sequence "
                         "of faces") from None
    if not given:
        raise InputError("faces: are none; give at least one")
    for k, face in enumerate(given):
        if isinstance(face, str) or not hasattr(face, "__len__"):
            raise InputError(f"faces: face {k} is {face!r}; give its corners, indices of vertices")
    return given


def _corners(faces: Any, vertices: int) -> tuple:
    """Corners and offsets of an (F, k) array, or of a sequence of faces of several lengths."""
    if not isinstance(faces, np.ndarray):
        faces = _faces_of(faces)
        if len({len(face) for face in faces}) > 1:
            lengths = np.array([len(face) for face in faces], dtype=np.uint64)
            flat = np.concatenate([np.asarray(face) for face in faces])
            corners = indices("faces", flat, [(None,)], vertices, "vertices")
            return corners, np.concatenate([[0], np.cumsum(lengths)]).astype(np.uint64), len(faces)
    corners = indices("faces", faces, [(None, None)], vertices, "vertices")
    count, size = corners.shape
    if size < 3:
        raise InputError(f"faces: have {size} corners; give (F, 3), (F, 4) or more corners a face")
    return corners.reshape(-1), np.arange(0, count * size + 1, size, dtype=np.uint64), count


def _group_of_faces(groups: Any, faces: int) -> tuple:
    """The group of each face, and names in the order in which they first stand."""
    if groups is None:
        return np.zeros(faces, dtype=np.uint32), ["surface"]
    given = np.asarray(groups)
    if given.shape != (faces,) or given.dtype.kind not in "uiUO":
        raise InputError(f"groups: has shape {given.shape} and dtype {given.dtype}; give one name or "
                         f"number a face, shape ({faces},)")
    if given.dtype.kind == "O":
        given = given.astype(str)
    names, first, of_face = np.unique(given, return_index=True, return_inverse=True)
    order = np.argsort(first)
    place = np.empty(len(names), dtype=np.uint32)
    place[order] = np.arange(len(names), dtype=np.uint32)
    return place[of_face.reshape(-1)], [str(names[k]) for k in order]


def _materials(names: Sequence[str], given: Optional[Mapping[Any, Mapping[str, Any]]]) -> list:
    if given is not None:
        require("materials", given, Mapping, "a dict by group")
    known: dict = {}
    for group, properties in (given or {}).items():
        require(f"material of {group!r}", properties, Mapping, "a dict of properties")
        known[str(group)] = dict(properties)
    for name, material in known.items():
        if name not in names:
            raise InputError(printable(f"materials: no group is called {name!r}; there are: "
                                       f"{', '.join(names)}"))
        unknown = [key for key in material if key not in _PLAIN]
        if unknown:
            raise InputError(f"materials: {name!r} has no property {unknown[0]!r}; there are: "
                             f"{', '.join(_PLAIN)}")
    made = []
    for name in names:
        material = {**_PLAIN, **known.get(name, {})}
        reflectance = _colour(f"reflectance of {name!r}", material["reflectance"])
        emission = _colour(f"emission of {name!r}", material["emission"])
        if not all(0 <= rho <= 1 for rho in reflectance):
            raise InputError(f"reflectance of {name!r}: is {material['reflectance']}; give 0 to 1")
        if not all(E >= 0 for E in emission):
            raise InputError(f"emission of {name!r}: is {material['emission']}; give W/m^2, 0 or more")
        two_sided = yes_or_no(f"two_sided of {name!r}", material["two_sided"])
        made.append((name, reflectance, emission, two_sided))
    return made


class Light(Fixed):
    """A light without a surface, for load() and Scene().

    kind: point, spot, sun, ies, cie-sky, perez-sky or image-sky. parameters: its strength by its name
    (intensity, W/sr; irradiance of what faces a sun, W/m^2; flux of a lamp, W; diffuse irradiance of
    open ground under a sky, W/m^2; one number, three, or a text with another unit, "800cd", "900lm",
    "10000lx"), what else the kind takes (at, aim, outer, elevation, ...; radiosity info --help lists
    them), and `name`. ies: `file` is the path of an IES LM-63 (.ies) or EULUMDAT (.ldt) file, which is
    read when the scene is made; its flux is the default.

    >>> rad.Light("point", intensity="800cd", at=(1, 2, 2.5), name="desk")
    <Light point,intensity=800cd,at=1,2,2.5,name=desk>
    >>> rad.Light("ies", file="lamps/panel.ldt", at=(0, 0, 3), turn=90)
    <Light ies,file=lamps/panel.ldt,at=0,0,3,turn=90>
    """

    def __init__(self, kind: str, **parameters: Any) -> None:
        require("kind", kind, str, "the kind of a light, e.g. 'point'")
        self._kind = kind
        self._text = ",".join(f"{name}={_light_value(name, value)}" for name, value in parameters.items())

    def __repr__(self) -> str:
        return printable(f"<Light {self._kind},{self._text}>")


def _light_value(name: str, value: Any) -> str:
    if name == "file":
        value = path_text(name, value)
    if isinstance(value, str):
        if not value:
            raise InputError(f"{name}: is an empty text; give a value, or leave it out")
        named = name in ("name", "file")
        return "".join(f"%{ord(c):02x}" if c in "%,;=| \n\t" else c for c in value) if named else value
    given = numbers(name, value, [(), (3,)], "one number, or three")
    return ",".join(f"{float(x):g}" if float(f"{float(x):g}") == float(x) else repr(float(x))
                    for x in given.reshape(-1))


def _lights(given: Mapping[str, Any], more_lights: Any = ()) -> list:
    """Word and text of each light."""
    texts_of = []
    for word, value in given.items():
        if value is None:
            continue
        if not isinstance(value, str):
            value = ",".join(map(repr, _colour(word, value)))
        elif not value:
            raise InputError(f"{word}: is an empty text; give its strength, or leave it out")
        texts_of.append((word.replace("_", "-"), value))
    listed = [more_lights] if isinstance(more_lights, (str, Light)) else list(more_lights)
    for light in listed:
        if isinstance(light, Light):
            texts_of.append((light._kind, light._text))
            continue
        require("lights", light, str, "rad.Light(...) or its text, 'point,800cd,at=1,2,2.5'")
        if not light:
            raise InputError("lights: has an empty text; give rad.Light(...) or 'point,800cd,at=1,2,2.5'")
        word, _, rest = light.partition(",")
        texts_of.append((word, rest))
    return texts_of


class Scene(Fixed):
    """Faces, their surfaces and materials.

    vertices: (V, 3) numbers, metres. faces: (F, 3), (F, 4) or wider whole numbers, or a sequence of
    faces of several lengths: indices of vertices, counter-clockwise seen from the front. groups: (F,)
    names or numbers; each group is a surface, by that name. materials: by group, a dict of
    `reflectance` (0 to 1; default 0.5), `emission` (radiant exitance, W/m^2; default 0), each one
    number or red, green and blue, and `two_sided`. sky: radiance where nothing stands, W/m^2/sr.
    lights: those without a surface, rad.Light(...) each.

    The arrays are copied once. Errors: InputError naming the argument and the row.

    >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> above = [[0, 0, 1], [0, 1, 1], [1, 1, 1], [1, 0, 1]]
    >>> scene = rad.Scene(square + above, [[0, 1, 2, 3], [4, 5, 6, 7]], groups=["floor", "lamp"],
    ...                   materials={"lamp": {"emission": 100}})
    >>> scene.surface_names
    ['floor', 'lamp']
    >>> scene.materials[1]["emission"]
    [100.0, 100.0, 100.0]
    """

    @takes_options("lights")
    def __init__(self, vertices: Any, faces: Any, groups: Any = None,
                 materials: Optional[Mapping[Any, Mapping[str, Any]]] = None,
                 sky: Any = 0.0, lights: Any = (), **others: Any) -> None:
        places = numbers("vertices", vertices, [(None, 3)])
        corners, offset, count = _corners(faces, len(places))
        surface, names = _group_of_faces(groups, count)
        self._handle = _core.scene_of_arrays(places, corners, offset, surface,
                                             _materials(names, materials),
                                             _lights(dict(sky=sky, **more("lights", others, "Scene")),
                                                     lights))

    @classmethod
    def _of(cls, handle: "_core.Scene") -> "Scene":
        scene = cls.__new__(cls)
        scene._handle = handle
        return scene

    @property
    def vertices(self) -> np.ndarray:
        """(V, 3) float64, metres; a view."""
        return self._handle.vertices

    @property
    def corners(self) -> np.ndarray:
        """uint32 vertices of all faces' corners, one face after the other; a view."""
        return self._handle.corners

    @property
    def face_offset(self) -> np.ndarray:
        """(F + 1,) uint64: corners of face f are corners[face_offset[f]:face_offset[f + 1]]; a view."""
        return self._handle.face_offset

    @property
    def face_surface(self) -> np.ndarray:
        """(F,) uint32, into surface_names; a view."""
        return self._handle.face_surface

    @property
    def surface_names(self) -> list:
        """Names of the surfaces: "object/material", or the one name that both have."""
        return self._handle.surface_names

    @property
    def materials(self) -> list:
        """A dict a material: name, reflectance (0 to 1) and emission (W/m^2) by colour, two_sided."""
        return self._handle.materials

    @property
    def cameras(self) -> list:
        """A dict a camera, as render() takes them: name, eye, target, up, vertical_fov (radians), aspect."""
        return self._handle.cameras

    @property
    def sky(self) -> list:
        """Radiance from every direction in which nothing stands, W/m^2/sr, by colour."""
        return self._handle.sky

    @property
    def notes(self) -> list:
        """What a reader of the scene should know: a dict of severity and text each."""
        return self._handle.notes

    def __repr__(self) -> str:
        return (f"<Scene of {len(self.face_surface):,} faces on {len(self.surface_names)} surfaces "
                f"from {printable(self._handle.file)}>")

    def _repr_html_(self) -> str:
        return summary(repr(self).strip("<>"), ["material", "reflectance", "", "emission, W/m^2", "sides"],
                       ([m["name"], swatch(m["reflectance"]), figure(m["reflectance"]), figure(m["emission"]),
                         "2" if m["two_sided"] else "1"] for m in self.materials))


@takes_options("scene", "overrides", "lights")
def load(path: Union[str, "os.PathLike[str]"], *,
         materials_file: Union[None, str, "os.PathLike[str]"] = None,
         sky: Any = None, lights: Any = (), **others: Any) -> Scene:
    """Reads a scene file, its format told by the extension (.obj, .glb, .stl, .msh, .ply, ...).

    Options that may be repeated are lists, or one text; set="lamp.emission=100". NAMEs are those of
    materials, objects or surfaces, patterns ("*wall*"), or "all". sky: radiance, W/m^2/sr, one
    number or three. lights: those without a surface, rad.Light(...) each; they replace the file's of
    their names. The options are those of the command line. What was repaired is in Scene.notes,
    and said by UserWarnings.

    The scene's arrays are views of what was read, no copies.

    Errors: InputError with file, element and cure.

    >>> rad.load("data/cornell-box.obj", set=["white.reflectance=0.9"])
    <Scene of 18 faces on 8 surfaces from data/cornell-box.obj>
    """
    kinds = {light["name"] for light in _core.options("lights")}
    lists = {option["name"] for option in _core.options("overrides") if isinstance(option["value"], list)}
    options = more(("scene", "overrides", "lights"), others, "load")
    given = {name: texts(name, value) if name in lists else value
             for name, value in options.items() if name not in kinds}
    if materials_file is not None:
        given["materials_file"] = path_text("materials_file", materials_file)
    given["lights"] = _lights({"sky": sky, **{name: options[name] for name in kinds & options.keys()}},
                              lights)
    scene = Scene._of(_core.load(path_text("path", path), given))
    tell(scene.notes)
    return scene
