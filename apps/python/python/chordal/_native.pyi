"""Models, meshes, surfaces and curves."""

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._api import Progress, Quantity

__version__: str

_Range = tuple[float, float]
_Box = tuple[_Range, _Range]
_Color = list[float]

def read(
    path: str | None,
    content: bytes | None,
    name: str,
    format: str | None,
    winding: str | None,
    progress: Progress | None,
) -> Model: ...
def run_command_line(arguments: Sequence[str]) -> int: ...

@final
class Model:
    """A CAD model: what a file holds, exactly."""

    @property
    def name(self) -> str:
        """The name that the file gives the model; may be empty."""
    @property
    def source(self) -> str:
        """The path of the file, or the name that the caller gave."""
    @property
    def format(self) -> str:
        """Format and version as the file states them."""
    @property
    def unit(self) -> str:
        """The file's unit of length, such as `mm`."""
    @property
    def parts(self) -> list[Part]:
        """The parts, each once however often it is placed."""
    @property
    def faces(self) -> list[Face]:
        """The faces of all parts, each once, in the order of the file. A face's number is its index here."""
    @property
    def edges(self) -> list[Edge]:
        """The edges of all parts, each once."""
    @property
    def instances(self) -> list[Instance]:
        """Every placed part, depth first in the order of the tree."""
    @property
    def tree(self) -> list[Node]:
        """The assembly, from its roots."""
    @property
    def info(self) -> dict[str, Any]:
        """What is in the file: tree, parts, faces by kind, gaps, problems; as `chordal info --json`."""
    @property
    def problems(self) -> list[dict[str, Any]]:
        """What the reader repaired, guessed or dropped, and the faces that it could not read."""
    def to_json(self) -> str:
        """The whole exact model as Chordal's own JSON (docs/model-json.md), without loss."""
    def mesh(
        self,
        tolerance: Quantity | None = None,
        angle: Quantity | None = 20,
        *,
        max_edge: Quantity | None = None,
        boundary_tolerance: Quantity | None = None,
        sew: Quantity | None = None,
        bound: str | None = None,
        strategy: str | None = None,
        edge_method: str | None = None,
        output_format: str | None = None,
        self_intersections: bool | None = None,
        face_timeout: float | None = None,
        file_timeout: float | None = None,
        memory: int | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
        tol_linear: float | None = None,
        tol_angular: float | None = None,
        tol_relative: bool | None = None,
    ) -> Mesh:
        """Meshes the model and audits the mesh.

        - `tolerance`: largest distance between the mesh and the exact surfaces: millimetres, a text with a
          unit, or a percentage of the diagonal of the model's box. Default: `"0.1%"`.
        - `angle`: largest angle between the exact normals at the two ends of a mesh edge, in degrees; `None`
          is no limit.
        - `max_edge`: longest mesh edge.
        - `boundary_tolerance`: a tolerance of its own for the edges of the model.
        - `sew`: `"auto"`, `"off"` or a length: whether faces that share no edges are joined.
        - `bound`: `"proven"` or `"estimated"`.
        - `strategy`, `edge_method`: a method of the literature by name.
        - `output_format`: the format that the mesh will be saved in; its rounding is kept back from the
          tolerance, as the command line does.
        - `self_intersections`: whether triangles that cut each other are looked for and parted.
        - `face_timeout`, `file_timeout`: seconds of an ordinary core; 0 is no limit.
        - `memory`: megabytes that the triangles may take; 0 is no limit.
        - `threads`: threads of this call alone; default: one per core, shared by all calls.
        - `progress`: called with the phase and the fraction that is done; `False` cancels.
        - `tol_linear`, `tol_angular` (radians), `tol_relative`: the names of cascadio and trimesh. With
          `tol_relative`, `tol_linear` is a fraction of the diagonal.
        """
    def info_json(self) -> str: ...
    def problems_json(self) -> str: ...
    def mesh_with(
        self, options: dict[str, Any] | None, threads: int | None, progress: Progress | None
    ) -> Mesh: ...

@final
class Node:
    """One occurrence in the assembly tree."""

    @property
    def name(self) -> str:
        """Its name; may be empty."""
    @property
    def part(self) -> Part | None:
        """The part that stands here."""
    @property
    def children(self) -> list[Node]:
        """What is below it."""
    @property
    def transform(self) -> NDArray[np.float64]:
        """To the parent's coordinates, of a root to millimetres, as a matrix (4, 4)."""
    @property
    def color(self) -> _Color | None:
        """Red, green, blue and opacity, linear, 0 to 1; it overrides the colours of everything below."""

@final
class Instance:
    """One placed part."""

    @property
    def index(self) -> int:
        """Its number: its index in `Model.instances`."""
    @property
    def name(self) -> str:
        """The name of its node in the tree; may be empty."""
    @property
    def part(self) -> Part:
        """The part."""
    @property
    def transform(self) -> NDArray[np.float64]:
        """From the part's coordinates to millimetres of the assembled model, as a matrix (4, 4)."""

@final
class Part:
    """One part, in its own coordinates and units."""

    @property
    def index(self) -> int:
        """Its number: its index in `Model.parts`."""
    @property
    def name(self) -> str:
        """Its name; may be empty."""
    @property
    def entity(self) -> str | None:
        """The entity in the file, `#123`."""
    @property
    def color(self) -> _Color | None:
        """Red, green, blue and opacity, linear, 0 to 1."""
    @property
    def faces(self) -> list[Face]:
        """Its faces, in the order of the file."""
    @property
    def edges(self) -> list[Edge]:
        """Its edges."""
    @property
    def vertices(self) -> NDArray[np.float64]:
        """Its vertices (n, 3)."""
    @property
    def solid_count(self) -> int:
        """The number of solid bodies."""
    @property
    def sheet_count(self) -> int:
        """The number of sheet bodies."""
    def adjacency(self) -> NDArray[np.uint32]:
        """Pairs of faces that share an edge, with the edge: (n, 3), numbers of `Model.faces` and `Model.edges`."""

@final
class Face:
    """One face of a part, as the file has it."""

    @property
    def index(self) -> int:
        """Its number: its index in `Model.faces`, which `Mesh.face_of_triangle` has."""
    @property
    def index_in_part(self) -> int:
        """Its index among the faces of its part."""
    @property
    def part(self) -> Part:
        """The part that it belongs to."""
    @property
    def name(self) -> str:
        """Its name; may be empty."""
    @property
    def color(self) -> _Color | None:
        """Red, green, blue and opacity, linear, 0 to 1: its own colour, not that of its body or part."""
    @property
    def layer(self) -> str | None:
        """The layer."""
    @property
    def entity(self) -> str | None:
        """The entity in the file, `#123`."""
    @property
    def line(self) -> int | None:
        """The line in the file, from 1."""
    @property
    def surface(self) -> Surface | None:
        """The exact surface under it, in the part's coordinates; `None` where the reader did not understand it."""
    @property
    def failure(self) -> str | None:
        """Why the reader did not understand the face."""
    @property
    def reversed(self) -> bool:
        """Whether the outward normal of the face is against that of its surface."""
    @property
    def loop_count(self) -> int:
        """The number of its loops."""
    @property
    def edges(self) -> list[int]:
        """The edges around it, by their numbers in `Model.edges`, in the order of its loops."""

@final
class Edge:
    """One edge of a part: a curve that faces share."""

    @property
    def index(self) -> int:
        """Its number: its index in `Model.edges`."""
    @property
    def part(self) -> Part:
        """The part that it belongs to."""
    @property
    def entity(self) -> str | None:
        """The entity in the file, `#123`."""
    @property
    def curve(self) -> Curve | None:
        """Its curve over its range, in the part's coordinates; `None` where the file gives none."""
    @property
    def vertices(self) -> tuple[int, int]:
        """The vertices at its two ends: indices into `Part.vertices`."""
    @property
    def faces(self) -> list[int]:
        """The faces that use it, by their numbers in `Model.faces`."""

@final
class Mesh:
    """The mesh of a model, audited, with its report."""

    @property
    def model(self) -> Model:
        """The model that was meshed."""
    @property
    def vertices(self) -> NDArray[np.float64]:
        """The vertices in millimetres of the assembled model: float64 (n, 3), read-only."""
    @property
    def triangles(self) -> NDArray[np.uint32]:
        """Indices into `vertices`: uint32 (m, 3), counter-clockwise seen from outside, read-only.

        Neighbouring triangles share their vertices.
        """
    @property
    def normals(self) -> NDArray[np.float64]:
        """The exact unit normals of the face at every corner: float64 (m, 3, 3), read-only."""
    @property
    def uv(self) -> NDArray[np.float64]:
        """Where every corner lies in the parameters of its face: float64 (m, 3, 2), read-only."""
    @property
    def face_of_triangle(self) -> NDArray[np.int32]:
        """The face of every triangle, a number of `Model.faces`: int32 (m,), read-only.

        -1 for triangles that were in the file already.
        """
    @property
    def placed_face_of_triangle(self) -> NDArray[np.int32]:
        """The face of every triangle, where the faces of every instance count: int32 (m,), read-only.

        The faces of all instances are counted one behind the other, as CAD kernels do; -1 for triangles that
        were in the file already.
        """
    @property
    def part_of_triangle(self) -> NDArray[np.uint32]:
        """The part of every triangle, a number of `Model.parts`: uint32 (m,), read-only."""
    @property
    def instance_of_triangle(self) -> NDArray[np.uint32]:
        """The instance of every triangle, a number of `Model.instances`: uint32 (m,), read-only."""
    @property
    def edges(self) -> list[Polyline]:
        """The edges of the model as polylines, as placed."""
    def uv_grids(self, nu: int = 10, nv: int = 10) -> NDArray[np.float64]:
        """A grid over every face, as UV-Net takes it: float64 (faces, nu, nv, 7), in the part's coordinates.

        The seven numbers are the point, the outward normal, and 1 inside the loops or 0 outside. Beside a
        curved loop the chords of this mesh decide what is inside.
        """
    @property
    def report(self) -> dict[str, Any]:
        """The report, as docs/report.md documents it."""
    @property
    def proven_error(self) -> float | None:
        """The largest proven distance between the exact faces and their triangles in millimetres.

        `None` where no face has a proof.
        """
    @property
    def gap(self) -> float:
        """The inaccuracy of the file: the largest distance of a vertex from a surface that uses it, in mm."""
    @property
    def clean(self) -> bool:
        """Whether no problem is an error: exit code 0 of the command line."""
    @property
    def watertight(self) -> bool:
        """Whether every shell is closed."""
    def save(
        self,
        path: str | PathLike[str],
        format: str | None = None,
        *,
        unit: str | None = None,
        up: str | None = None,
        edges: bool = False,
    ) -> Written:
        """Writes a file: stl, stl-ascii, ply, obj, glb, gltf or 3mf, by its extension unless `format` is given.

        A file that exists is replaced only once the new one is complete. `unit`: um, mm, cm, m, in or ft.
        `up`: y or z. `edges`: also the edges of the model as lines (GLB and glTF).
        """
    def to_bytes(
        self, format: str = "glb", *, unit: str | None = None, up: str | None = None, edges: bool = False
    ) -> bytes:
        """The bytes of a mesh file; the options of `save`."""
    def to_trimesh(self) -> Any:
        """A `trimesh.Scene`: one geometry for each placed part, with its name and the faces of its triangles."""
    def to_pyvista(self) -> Any:
        """A `pyvista.PolyData` with the cell arrays `face`, `part` and `instance`."""
    def to_open3d(self) -> Any:
        """An `open3d.geometry.TriangleMesh`."""
    def to_meshio(self) -> Any:
        """A `meshio.Mesh` with the cell data `face`, `part` and `instance`."""
    def problem_sentences(self) -> list[tuple[str, str]]:
        """One line per problem: its severity, its sentence."""

@final
class Polyline:
    """An edge of the model as a polyline, as placed."""

    @property
    def points(self) -> NDArray[np.float64]:
        """The points in millimetres: float64 (n, 3), vertices of the triangles beside it."""
    @property
    def edge(self) -> int:
        """The edge, a number of `Model.edges`."""
    @property
    def part(self) -> int:
        """The part, a number of `Model.parts`."""
    @property
    def instance(self) -> int:
        """The instance, a number of `Model.instances`."""

@final
class Written:
    """What was written."""

    @property
    def path(self) -> Path:
        """The file."""
    @property
    def triangles(self) -> int:
        """Its triangles, with every instance counted."""
    @property
    def bytes(self) -> int:
        """Its size in bytes."""
    @property
    def rounding(self) -> float:
        """The largest distance in millimetres by which rounding to 32 bits moved a vertex."""
    @property
    def warnings(self) -> list[str]:
        """What the file's user should know."""

@final
class Surface:
    """A surface, with parameters as in STEP (ISO 10303-42): angles are radians."""

    @staticmethod
    def nurbs(
        degree: tuple[int, int],
        knots_u: ArrayLike,
        knots_v: ArrayLike,
        points: ArrayLike,
        weights: ArrayLike | None = None,
    ) -> Surface:
        """A NURBS surface: `points` (nu, nv, 3), `weights` (nu, nv), knots with `n + degree + 1` values."""
    @property
    def kind(self) -> str:
        """Its kind: plane, cylinder, cone, sphere, torus, extrusion, revolution, nurbs or offset."""
    @property
    def domain(self) -> _Box:
        """The range of u and the range of v; infinite where it has no end."""
    @property
    def periods(self) -> tuple[float | None, float | None]:
        """The periods along u and v."""
    def evaluate(self, uv: ArrayLike) -> NDArray[np.float64]:
        """The points at `uv` (…, 2): (…, 3)."""
    def normals(self, uv: ArrayLike) -> NDArray[np.float64]:
        """The unit normals at `uv` (…, 2): (…, 3); NaN at a point that has none."""
    def derivatives(self, uv: ArrayLike) -> NDArray[np.float64]:
        """The point and its derivatives at `uv` (…, 2): (…, 6, 3), in the order S, Su, Sv, Suu, Suv, Svv."""
    def invert(
        self, points: ArrayLike, uv_range: _Box | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The nearest parameters to `points` (…, 3): (…, 2), and their distances (…)."""
    def to_nurbs(self, uv_range: _Box | None = None) -> Surface:
        """The exact NURBS form over a range of parameters, the whole domain where none is given."""
    @property
    def degree(self) -> tuple[int, int]:
        """The degrees along u and v."""
    @property
    def knots_u(self) -> NDArray[np.float64]:
        """The knots along u."""
    @property
    def knots_v(self) -> NDArray[np.float64]:
        """The knots along v."""
    @property
    def points(self) -> NDArray[np.float64]:
        """The control points (nu, nv, 3), not multiplied by weights."""
    @property
    def weights(self) -> NDArray[np.float64] | None:
        """The weights (nu, nv); `None` where all are equal."""
    def with_points(self, points: ArrayLike) -> Surface:
        """The same surface with control points moved to `points` (nu, nv, 3)."""
    def insert_knot_u(self, u: float, times: int = 1) -> Surface:
        """The same surface with a knot inserted along u."""
    def insert_knot_v(self, v: float, times: int = 1) -> Surface:
        """The same surface with a knot inserted along v."""
    def piece(self, uv_range: _Box) -> Surface:
        """The part of a NURBS surface over a range of parameters."""
    def bezier_patches(self) -> list[BezierPatch]:
        """The polynomial pieces of a NURBS surface, u outer and v inner."""

@final
class BezierPatch:
    """A polynomial piece of a surface over the unit square."""

    @property
    def points(self) -> NDArray[np.float64]:
        """The control points (p + 1, q + 1, 3), not multiplied by weights."""
    @property
    def weights(self) -> NDArray[np.float64] | None:
        """The weights (p + 1, q + 1); `None` for a polynomial patch."""
    @property
    def uv_range(self) -> _Box:
        """The ranges of u and v of the surface that it covers."""

@final
class Curve:
    """A curve in space over a range of its parameter, with parameters as in STEP (ISO 10303-42)."""

    @staticmethod
    def nurbs(degree: int, knots: ArrayLike, points: ArrayLike, weights: ArrayLike | None = None) -> Curve:
        """A NURBS curve: `points` (n, 3), `weights` (n,), `n + degree + 1` knots."""
    @property
    def range(self) -> _Range:
        """The range of the parameter."""
    def evaluate(self, t: ArrayLike) -> NDArray[np.float64]:
        """The points at the parameters `t` (…): (…, 3)."""
    def derivatives(self, t: ArrayLike) -> NDArray[np.float64]:
        """The point and its first two derivatives at the parameters `t` (…): (…, 3, 3)."""
    def invert(self, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The nearest parameters to `points` (…, 3): (…), and their distances (…)."""
    def grid(self, count: int = 10) -> NDArray[np.float64]:
        """A grid of `count` points over the range: float64 (count, 6): the point and the unit tangent."""
    def to_nurbs(self) -> Curve:
        """The exact NURBS form over the range."""
    @property
    def degree(self) -> int:
        """The degree of a NURBS curve."""
    @property
    def knots(self) -> NDArray[np.float64]:
        """The knots of a NURBS curve."""
    @property
    def points(self) -> NDArray[np.float64]:
        """The control points (n, 3) of a NURBS curve, not multiplied by weights."""
    @property
    def weights(self) -> NDArray[np.float64] | None:
        """The weights of a NURBS curve; `None` where all are equal."""
    def insert_knot(self, t: float, times: int = 1) -> Curve:
        """The same curve with a knot inserted."""
    def bezier_pieces(self) -> list[tuple[NDArray[np.float64], _Range]]:
        """The control points of the polynomial pieces of a NURBS curve, each (degree + 1, 3), with their ranges."""
