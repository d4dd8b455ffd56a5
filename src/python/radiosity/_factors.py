"""Form factors: of meshes, of matrices from elsewhere, between surfaces, from points."""

from __future__ import annotations

import os
import threading
from dataclasses import dataclass
from typing import Any, List, Optional, Sequence, Tuple, Union

import numpy as np
import scipy.sparse

from . import _core
from ._arrays import Fixed, numbers, path_text, printable, require, texts
from ._core import InputError
from ._html import figure, summary
from ._mesh import Mesh
from ._names import surfaces_named
from ._notes import tell, warn
from ._options import more, takes_options
from ._progress import Progress, reporting


@dataclass(frozen=True)
class Table(Fixed):
    """Form factors between S named surfaces; made by FormFactors.table(). Text of it is Markdown.

    names: S texts. area: (S,) m^2, both sides of a two-sided surface. factors: (S, S), where
    factors[a, b] is the fraction of the light leaving names[a] that reaches names[b]. sky, backs:
    (S,), the fractions that go to the sky and to black backs. error: (S, S), the error bound of each
    factor; NaN if the method has no error figures. Arrays are float64, read only.
    """

    names: List[str]
    area: np.ndarray
    factors: np.ndarray
    sky: np.ndarray
    backs: np.ndarray
    error: np.ndarray
    _text: str = ""

    def __post_init__(self) -> None:
        for array in (self.area, self.factors, self.sky, self.backs, self.error):
            array.flags.writeable = False

    def __str__(self) -> str:
        return self._text

    def _repr_markdown_(self) -> str:
        return self._text

    def between(self, a: str, b: str) -> float:
        """The fraction of what leaves `a` that reaches `b`: surfaces, or all surfaces of a material or
        an object.

        Errors: InputError for a name that is not there, with those that are.
        """
        of_a, of_b = surfaces_named(self.names, a), surfaces_named(self.names, b)
        sums = self.factors[np.ix_(of_a, of_b)].sum(axis=1)
        weights = self.area[of_a]
        return float(weights @ sums / weights.sum()) if weights.any() else 0.0


class FormFactors(Fixed):
    """F of shape (rows, rows): F[i, j] is the fraction of what leaves i that reaches j.

    Rows are patches of the mesh; of from_csr() those of the matrix. Made by form_factors(), from_csr() and read().
    It is used as the matrix: F @ x and x @ F, F[i, j], F[i], F[:, j], F.T (scipy's), np.asarray(F). F @ x needs
    no list of entries; all others make F.csr.

    >>> F = rad.form_factors(rad.mesh(rad.load("data/furnace-cube.obj"), patches=24))
    >>> F
    <FormFactors of 24 rows, exact>
    >>> (F @ F.area).shape, round(float(F[3].sum()), 4)
    ((24,), 1.0)
    """

    __array_ufunc__ = None  # so that numpy leaves x @ F to __rmatmul__

    def __init__(self, handle: "_core.FormFactors", mesh: Optional[Mesh] = None) -> None:
        self._handle = handle
        self._mesh = mesh
        self._csr: Optional[scipy.sparse.csr_matrix] = None
        self._table: Optional[Table] = None
        self._making = threading.Lock()  # of _csr: all threads get the same one

    def __len__(self) -> int:
        return len(self._handle.area)

    @property
    def shape(self) -> Tuple[int, int]:
        """(rows, rows)."""
        return len(self), len(self)

    @property
    def T(self) -> scipy.sparse.csc_matrix:
        """The transposed matrix: what reaches i of what leaves j. It shares its values with csr."""
        return self.csr.T

    def __matmul__(self, x: Any) -> Any:
        """F x in float64; x: (rows,) or (rows, columns) numbers, or a sparse matrix, which gives one."""
        if scipy.sparse.issparse(x):
            return self.csr @ x
        values = numbers("x", x, [(len(self),), (len(self), None)])
        return _core.product(self._handle, values.reshape(len(self), -1)).reshape(values.shape)

    def __rmatmul__(self, x: Any) -> Any:
        return x @ self.csr

    def __getitem__(self, key: Any) -> Any:
        """As of np.asarray(self), without a copy of the rest."""
        row, column = key if isinstance(key, tuple) else (key, slice(None))
        part = self.csr[row, column]
        if scipy.sparse.issparse(part):
            single = [not isinstance(k, slice) and np.ndim(k) == 0 for k in (row, column)]
            return part.toarray().squeeze(tuple(np.flatnonzero(single)))
        return np.asarray(part).reshape(np.broadcast(row, column).shape) if np.ndim(part) else part

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> np.ndarray:
        if copy is False:
            raise ValueError("form factors are stored as runs of columns: an array of them is a copy")
        return self.csr.toarray().astype(dtype or self.csr.dtype, copy=False)

    @property
    def mesh(self) -> Optional[Mesh]:
        """The mesh; None of a matrix from elsewhere."""
        return self._mesh

    @property
    def csr(self) -> scipy.sparse.csr_matrix:
        """The matrix, (rows, rows), float32 or float64 as it is stored; read only.

        The first call assembles it (a copy: F is stored as runs, a symmetric one once a pair);
        later ones return the same object.

        >>> F = rad.form_factors(rad.mesh(rad.load("data/furnace-cube.obj"), patches=24))
        >>> F.csr.shape, float(abs(F.csr.sum(axis=1) - 1).max()) < 1e-4
        ((24, 24), True)
        """
        if self._csr is None:
            with self._making:
                if self._csr is None:
                    self._csr = self._rows()
        return self._csr

    def _rows(self) -> scipy.sparse.csr_matrix:
        with reporting(None) as report:
            data, indices, starts = _core.csr_arrays(self._handle, report)
        n = len(self)
        matrix = scipy.sparse.csr_matrix((data, indices, starts), shape=(n, n), copy=False)
        matrix.has_sorted_indices = True
        matrix.has_canonical_format = True
        for array in (matrix.data, matrix.indices, matrix.indptr):
            array.flags.writeable = False
        return matrix

    @property
    def area(self) -> np.ndarray:
        """(rows,) float64, m^2; a view."""
        return self._handle.area

    @property
    def fronts(self) -> np.ndarray:
        """(rows,) float64: what of a row reaches patches, its sum; a view."""
        return self._handle.fronts

    @property
    def sky(self) -> np.ndarray:
        """(rows,) float64: what of a row goes to the sky; a view."""
        return self._handle.sky

    @property
    def backs(self) -> np.ndarray:
        """(rows,) float64: what of a row goes to black backs; a view."""
        return self._handle.backs

    @property
    def error(self) -> np.ndarray:
        """(rows,) float64: error figures; the 2-norm of a row's error is below its own in about 99%
        of rows. Empty where the method has none (cut, hemicube). A view."""
        return self._handle.error

    @property
    def method(self) -> str:
        """exact, rays, cut or hemicube; of from_csr() "matrix", of a matrix in a file "file"."""
        return self._handle.method

    @property
    def report(self) -> dict:
        """What the computation did, a dict.

        method_reason: why the method was chosen. closed: no row sees the sky. error_figure: the whole
        matrix's, relative; largest_row_error: how far a row's sum is above 1, or off 1 if closed.
        reciprocity_residual: of hemicubes. symmetrized, closure_enforced, closure (a dict: residuals
        before and after, moves). seconds, seconds_plan, estimated_seconds, matrix_bytes,
        estimated_bytes. polygons, empty_rows, exact_rows, simd_target. exact, rays, cut: dicts of the
        work that these methods did or skipped, and its seconds; of hemicubes: hemicubes, pixels,
        rasterised_polygons, skipped_..., near_pairs, capped. notes: a dict of severity and text each.
        """
        return self._handle.report

    def table(self, groups: Union[str, Sequence[str]] = (), progress: Progress = None) -> Table:
        """Form factors between surfaces by name. Its arrays are no views; without groups every call
        returns the same table.

        groups: "NAME=PATTERN", one or a list: surfaces that match a pattern of the shell under one
        name.
        Of a matrix from elsewhere: rows of one name are together, and there are no groups.

        >>> F = rad.form_factors(rad.mesh(rad.load("data/cornell-box.obj"), patches=100))
        >>> table = F.table(groups=["boxes=*block/*"])
        >>> "boxes" in table.names
        True
        """
        if not groups and self._table is not None:
            return self._table
        if self._mesh is None:
            if groups:
                raise InputError("groups: are of surfaces of a mesh; name the rows in from_csr()")
            self._table = self._table_of_rows()
            return self._table
        with reporting(progress) as report:
            got = _core.table(self._handle, texts("groups", groups), report)
        n = len(got["names"])
        table = Table(got["names"], got["area"], got["factors"].reshape(n, n), got["sky"],
                      got["backs"], got["entry_error"].reshape(n, n), got["markdown"])
        if not groups:
            self._table = table
        return table

    def between(self, a: str, b: str) -> float:
        """The fraction of what leaves `a` that reaches `b`, as Table.between().

        >>> F = rad.form_factors(rad.mesh(rad.load("data/facing-plates.obj"), patches=50))
        >>> a, b = F.mesh.surface_names
        >>> round(F.between(a, b), 5)  # Howell C-11
        0.19982
        """
        return self.table().between(a, b)

    def save(self, path: Union[str, "os.PathLike[str]"], solution: Any = None, heat: Any = None,
             progress: Progress = None) -> None:
        """Writes scene, mesh and form factors, and a Solution and a Heat on them, as a results file
        (HDF5, .h5), which read() and the command line take up. A file of that name is replaced. The
        matrix is not copied.

        Errors: InputError for another ending than .h5 and for form factors without a mesh; RunError
        where the disk is full; the file then is what it was.
        """
        name = path_text("path", path)
        if not name.lower().endswith(".h5"):
            raise InputError(f"{name}: is no name of a results file; end it in .h5")
        light = self._part("solution", solution, _core.Solution, "a Solution: rad.solve(F)")
        exchanged = self._part("heat", heat, _core.Heat, "a Heat: rad.heat(F, ...)")
        with reporting(progress) as report:
            _core.save(name, self._handle, light, exchanged, report)

    def _part(self, name: str, part: Any, kind: type, cure: str) -> Any:
        """The handle of what is saved with the form factors."""
        if part is None:
            return None
        if not isinstance(getattr(part, "_handle", None), kind):
            raise InputError(f"{name}: is of type {type(part).__name__}; give {cure}")
        if part.form_factors._handle is not self._handle:
            raise InputError(f"{name}: is of other form factors; give one that was made of these")
        return part._handle

    def _table_of_rows(self) -> Table:
        if not self._handle.names:
            raise InputError("table: the rows have no names; give names=... to from_csr()")
        names = list(dict.fromkeys(self._handle.names))
        place = {name: k for k, name in enumerate(names)}
        group = [place[name] for name in self._handle.names]
        member = scipy.sparse.csr_matrix((np.ones(len(group)), (range(len(group)), group)))
        area = member.T @ self.area
        each = np.divide(1.0, area, out=np.zeros_like(area), where=area > 0)
        weighted = member.T @ scipy.sparse.diags(self.area)
        factors = (weighted @ self._rows().astype(np.float64) @ member).toarray() * each[:, None]
        nothing = np.full(factors.shape, np.nan)
        lines = ["| from | " + " | ".join(names) + " | sky |", "|---" * (len(names) + 2) + "|"]
        sky = (weighted @ self.sky) * each
        for name, row, lost in zip(names, factors, sky):
            lines.append(f"| {name} | " + " | ".join(f"{f:.6g}" for f in row) + f" | {lost:.6g} |")
        return Table(names, area, factors, sky, (weighted @ self.backs) * each, nothing,
                     printable("\n".join(lines) + "\n"))

    def __repr__(self) -> str:
        return f"<FormFactors of {len(self):,} rows, {self.method}>"

    def _repr_html_(self) -> str:
        total = max(float(self.area.sum()), 1e-300)
        rows = [[words, figure(self.area @ share / total)] for words, share in
                [("reaches patches", self.fronts), ("goes to the sky", self.sky), ("goes to black backs", self.backs)]]
        if len(self.error):
            rows.append(["error of the matrix, relative", figure(self.report["error_figure"])])
        return summary(repr(self).strip("<>"), ["of what leaves, by area", "mean"], rows)


def _resident_bytes() -> int:
    try:
        with open("/proc/self/statm", encoding="ascii") as statm:
            return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return 0


@takes_options("form_factors")
def form_factors(mesh: Mesh, tolerance: Optional[float] = None, *, method: str = "auto",
                 closure: str = "report", precision: Optional[str] = None, resolution: int = 256,
                 eye: str = "cpu", seed: int = 1, near_exact: bool = False,
                 symmetrize: bool = False, exact_emitters: bool = True, memory_limit: int = 0,
                 scratch_folder: Union[str, "os.PathLike[str]"] = "",
                 progress: Progress = None, **others: Any) -> FormFactors:
    """Computes the form factors of a mesh.

    tolerance: relative to the mean form factor, 1e-12 to 0.1 (default: exact 1e-3, rays 1e-2); of cut
    that of irradiance (2e-2). method: auto (exact or rays), exact, rays, cut or hemicube. closure: off,
    report or enforce. precision: single or double (default: single unless the tolerance asks for more).
    memory_limit: bytes, 0: none; beyond it rows are kept in scratch_folder, where one is given. seed:
    of the directions of rays and of the turns of hemicubes about their normals; another one gives
    another sample of the same quality. exact_emitters: form factors to and from what emits are exact,
    also beside rays, cut and hemicubes. cut is for many patches: its rows hold nodes of a tree in place
    of pairs; they solve as others do, but csr cannot list them.

    Of hemicubes alone: resolution, pixels along an edge, even, 16 to 4096. eye: who draws them: cpu
    (the same bits on every machine), gl (OpenGL) or auto (OpenGL where there is hardware for it).
    near_exact: pairs nearer than two patch sizes, where pixels are coarse, get their area-to-area
    value times the visible fraction. symmetrize: both estimates of a pair are merged, so that A_i F_ij
    = A_j F_ji, and rows are closed. A UserWarning names options that the method does not use.

    The mesh is kept, not copied. The same options give the same bits as on the command line.

    Errors: InputError for options out of range; RunError where memory_limit is exceeded.

    >>> mesh = rad.mesh(rad.load("data/facing-plates.obj"), patches=8)
    >>> rad.form_factors(mesh, method="hemicube", resolution=64)
    <FormFactors of 8 rows, hemicube>
    """
    require("mesh", mesh, Mesh, "a Mesh: rad.mesh(scene)")
    options = dict(tolerance=tolerance, method=method, closure=closure, precision=precision,
                   resolution=resolution, eye=eye, seed=seed, near_exact=near_exact,
                   symmetrize=symmetrize, exact_emitters=exact_emitters, memory_limit=memory_limit,
                   scratch_folder=path_text("scratch_folder", scratch_folder) if scratch_folder else "",
                   memory_held=_resident_bytes() if memory_limit else 0, **more("form_factors", others))
    with reporting(progress) as report:
        factors = FormFactors(_core.form_factors(mesh._handle, options, report), mesh)
    tell(factors.report["notes"])
    unused = _core.unused_options(options, factors.method)
    if unused:
        warn(f"not used by the method {factors.method}: {', '.join(unused)}")
    return factors


def _checked(matrix: Any) -> Any:
    """InputError where the arrays of a sparse matrix do not fit each other: scipy trusts them."""
    try:
        if hasattr(matrix, "check_format"):
            matrix.check_format(full_check=True)
        elif matrix.format == "coo":
            for name, places, size in zip(("row", "column"), (matrix.row, matrix.col), matrix.shape):
                if len(places) and not 0 <= places.min() <= places.max() < size:
                    raise ValueError(f"a {name} is outside 0 to {size - 1}")
    except (ValueError, IndexError, TypeError) as error:
        raise InputError(f"matrix: is no valid {matrix.format} matrix: {error}; make it anew from "
                         "its entries") from None
    return matrix


def _shares(name: str, value: Any, rows: int) -> np.ndarray:
    """One a row, 0 or more: its area, or what of it goes somewhere."""
    array = numbers(name, value, [(rows,)], "one a row")
    below = np.flatnonzero(array < 0)
    if len(below):
        raise InputError(f"{name}: row {below[0]} is {array[below[0]]}; give 0 or more")
    return array


def from_csr(matrix: Any, area: Any, *, sky: Any = None, backs: Any = None,
             names: Optional[Sequence[str]] = None) -> FormFactors:
    """Form factors of one's own: a scipy matrix or an array (n, n), >= 0, and areas (n,), m^2.

    Values are copied; float32 is kept as such, all else becomes float64. sky, backs: (n,), what of a
    row goes there (default: to the sky what the row lacks of 1, to backs nothing). names: (n,), for
    messages and tables; need not be unique. A UserWarning says where rows sum to more than 1, or where
    A_i F_ij is far from A_j F_ji.

    Errors: InputError for wrong shapes, and values that are negative or not finite, by row: of the
    matrix, the areas, sky and backs.

    >>> F = rad.from_csr([[0, 1], [1, 0]], area=[1, 1], names=["hot", "cold"])
    >>> F.between("hot", "cold")
    1.0
    """
    given = _checked(matrix) if scipy.sparse.issparse(matrix) else numbers("matrix", matrix, [(None, None)])
    if given.dtype.kind not in "buif":
        raise InputError(f"matrix: has dtype {given.dtype}; give real numbers")
    single = getattr(matrix, "dtype", None) == np.float32
    csr = scipy.sparse.csr_matrix(given, dtype=np.float64)
    n = csr.shape[0]
    if csr.shape != (n, n):
        raise InputError(f"matrix: has shape {csr.shape}; give as many columns as rows")
    areas = _shares("area", area, n)
    if not csr.has_canonical_format or not np.all(csr.data):
        csr = csr.copy()
        csr.sum_duplicates()
        csr.eliminate_zeros()
    bad = np.flatnonzero(~(np.isfinite(csr.data) & (csr.data > 0)))
    if len(bad):
        row = int(np.searchsorted(csr.indptr, bad[0], side="right")) - 1
        raise InputError(f"matrix: row {row}, column {csr.indices[bad[0]]} is {csr.data[bad[0]]}; "
                         "form factors are finite and not negative")
    sums = np.asarray(csr.sum(axis=1)).reshape(-1)
    lost = np.zeros(n) if backs is None else _shares("backs", backs, n)
    rest = np.where(areas > 0, 1 - sums - lost, 0.0) if sky is None else _shares("sky", sky, n)
    handle = _core.from_csr(csr.data, csr.indices.astype(np.uint32), csr.indptr.astype(np.int64),
                            areas, rest, lost, _row_names(names, n), single)
    factors = FormFactors(handle)
    tell(factors.report["notes"])
    return factors


def _row_names(names: Optional[Sequence[str]], rows: int) -> List[str]:
    if names is None:
        return []
    if not hasattr(names, "__iter__"):
        raise InputError(f"names: is of type {type(names).__name__}; give {rows} texts, one a row")
    given = [names] if isinstance(names, str) else [str(name) for name in names]
    if len(given) != rows:
        raise InputError(f"names: are {len(given)}; give {rows}, one a row")
    return given


def view_factors_from(mesh: Mesh, points: Any, normals: Any, progress: Progress = None) -> np.ndarray:
    """Form factors from points to patches: what sensors see, (P, N) float64.

    points: (P, 3), metres. normals: (P, 3), of any length but 0, or (3,) for all. Exact, with what is
    in between clipped off; a point may be anywhere, and one on a surface sees what is on the side
    that its normal points to. The rest of a row to 1 goes to the sky and to backs. The irradiance at
    the points is view_factors_from(...) @ light.radiosity, W/m^2. The array is written in place: no
    copy.

    Errors: InputError naming the point or the normal.

    >>> mesh = rad.mesh(rad.load("data/furnace-cube.obj"), patches=24)
    >>> middle = mesh.vertices.mean(axis=0)
    >>> row = rad.view_factors_from(mesh, [middle], [0, 0, 1])
    >>> row.shape, float(row.sum().round(9))
    ((1, 24), 1.0)
    """
    require("mesh", mesh, Mesh, "a Mesh: rad.mesh(scene)")
    places = numbers("points", points, [(None, 3)])
    directions = numbers("normals", normals, [(len(places), 3), (3,)])
    if directions.ndim == 1:
        directions = np.ascontiguousarray(np.broadcast_to(directions, places.shape))
    with reporting(progress) as report:
        return _core.from_points(mesh._handle, places, directions, report)
