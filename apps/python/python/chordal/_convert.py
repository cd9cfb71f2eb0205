"""To and from the classes of other packages. Each is imported only when it is needed."""

from __future__ import annotations

import importlib
import io
from typing import TYPE_CHECKING, Any

import numpy as np

from ._api import Quantity, mesh_model, read
from ._errors import RequestError
from ._native import Curve, Surface

if TYPE_CHECKING:
    from ._native import Mesh, Model


def _package(module: str, package: str, what: str) -> Any:
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f"{what} needs {package}; install it with `pip install {package}` ({error})") from error


def _split(mesh: Mesh) -> list[tuple[int, slice]]:
    """The instances with triangles, each with its slice of the triangles: they are in order."""
    instances = mesh.instance_of_triangle
    borders = np.flatnonzero(np.diff(instances)) + 1
    starts = [0, *borders.tolist()] if len(instances) else []
    ends = [*borders.tolist(), len(instances)]
    return [(int(instances[a]), slice(a, b)) for a, b in zip(starts, ends)]


def _compact(mesh: Mesh, part: slice) -> tuple[Any, Any]:
    """The vertices and triangles of a slice of the triangles."""
    used, triangles = np.unique(mesh.triangles[part], return_inverse=True)
    return mesh.vertices[used], triangles.reshape(-1, 3)


def to_trimesh(mesh: Mesh) -> Any:
    """A `trimesh.Scene` with one geometry for each placed part."""
    trimesh = _package("trimesh", "trimesh", "to_trimesh")
    scene = trimesh.Scene()
    names: set[str] = set()
    instances = mesh.model.instances
    for number, part in _split(mesh):
        instance = instances[number]
        vertices, triangles = _compact(mesh, part)
        geometry = trimesh.Trimesh(vertices, triangles, process=False)
        geometry.face_attributes["cad_face"] = mesh.face_of_triangle[part].copy()
        geometry.units = "millimeters"
        geometry.metadata.update(part=instance.part.index, instance=number, name=instance.part.name)
        base = instance.part.name or instance.name or f"part {instance.part.index}"
        name = base
        count = 1
        while name in names:
            count += 1
            name = f"{base} ({count})"
        names.add(name)
        scene.add_geometry(geometry, node_name=name, geom_name=name)
    scene.units = "millimeters"
    return scene


def to_pyvista(mesh: Mesh) -> Any:
    """A `pyvista.PolyData` with the cell arrays `face`, `part` and `instance`."""
    pyvista = _package("pyvista", "pyvista", "to_pyvista")
    triangles = mesh.triangles
    cells = np.empty((len(triangles), 4), dtype=np.int64)
    cells[:, 0] = 3
    cells[:, 1:] = triangles
    data = pyvista.PolyData(mesh.vertices.copy(), cells.ravel())
    data.cell_data["face"] = mesh.face_of_triangle.copy()
    data.cell_data["part"] = mesh.part_of_triangle.copy()
    data.cell_data["instance"] = mesh.instance_of_triangle.copy()
    return data


def to_open3d(mesh: Mesh) -> Any:
    """An `open3d.geometry.TriangleMesh`."""
    open3d = _package("open3d", "open3d", "to_open3d")
    vertices = open3d.utility.Vector3dVector(mesh.vertices)
    triangles = open3d.utility.Vector3iVector(mesh.triangles.astype(np.int32))
    return open3d.geometry.TriangleMesh(vertices, triangles)


def to_meshio(mesh: Mesh) -> Any:
    """A `meshio.Mesh` with the cell data `face`, `part` and `instance`."""
    meshio = _package("meshio", "meshio", "to_meshio")
    data = {
        "face": [mesh.face_of_triangle.copy()],
        "part": [mesh.part_of_triangle.astype(np.int32)],
        "instance": [mesh.instance_of_triangle.astype(np.int32)],
    }
    cells = [("triangle", mesh.triangles.astype(np.int64))]
    return meshio.Mesh(mesh.vertices.copy(), cells, cell_data=data)


def _wrapped(shape: Any) -> Any:
    """The shape of OCP inside an object of CadQuery or build123d."""
    if hasattr(shape, "val") and not hasattr(shape, "wrapped"):
        shape = shape.val()
    inner = getattr(shape, "wrapped", shape)
    if not hasattr(inner, "ShapeType"):
        raise TypeError(f"shape: a shape of OCP, CadQuery or build123d is needed, not {type(shape).__name__}")
    return inner


def from_ocp(shape: Any) -> Model:
    """The model of a shape of OCP, CadQuery or build123d, through its BREP form in memory.

    The faces are in the order of `shape.Faces()` (`TopExp_Explorer`). A shape that a compound has twice is one
    part with two instances: `Mesh.placed_face_of_triangle` counts its faces twice, as `shape.Faces()` does.
    """
    tools = _package("OCP.BRepTools", "cadquery-ocp", "from_ocp").BRepTools
    text = io.BytesIO()
    version = _package("OCP.TopTools", "cadquery-ocp", "from_ocp").TopTools_FormatVersion
    # Without the triangles that the shape may have.
    tools.Write_s(_wrapped(shape), text, False, False, version.TopTools_FormatVersion_VERSION_1)
    return read(text.getvalue(), "brep", name="shape")


def tessellate(
    shape: Any, tolerance: Quantity, angularTolerance: float = 0.1
) -> tuple[list[tuple[float, float, float]], list[tuple[int, int, int]]]:
    """Vertices and triangles of a shape, with the signature of CadQuery's `Shape.tessellate`.

    `tolerance` is millimetres and proven, `angularTolerance` radians. CadQuery returns its own vectors; these
    are tuples.
    """
    mesh = mesh_model(from_ocp(shape), tolerance, tol_angular=angularTolerance)
    vertices = [(x, y, z) for x, y, z in mesh.vertices.tolist()]
    triangles = [(a, b, c) for a, b, c in mesh.triangles.tolist()]
    return vertices, triangles


def from_geomdl(shape: Any) -> Surface | Curve:
    """A curve or surface of geomdl (NURBS-Python), exactly."""
    weights = getattr(shape, "weights", None)
    if hasattr(shape, "knotvector_u"):
        counts = (shape.ctrlpts_size_u, shape.ctrlpts_size_v)
        points = np.asarray(shape.ctrlpts, dtype=float).reshape(*counts, -1)
        net = None if weights is None else np.asarray(weights, dtype=float).reshape(counts)
        degree = (shape.degree_u, shape.degree_v)
        return Surface.nurbs(degree, shape.knotvector_u, shape.knotvector_v, points, net)
    if hasattr(shape, "knotvector"):
        points = np.asarray(shape.ctrlpts, dtype=float)
        if points.shape[-1] == 2:
            points = np.column_stack([points, np.zeros(len(points))])
        return Curve.nurbs(shape.degree, shape.knotvector, points, weights)
    raise RequestError("shape: a curve or surface of geomdl is needed")
