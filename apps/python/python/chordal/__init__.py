"""CAD geometry in, watertight triangle meshes with a proven error out.

>>> import chordal
>>> mesh = chordal.mesh("bracket.step", tolerance="0.1%")
>>> mesh.save("bracket.glb")
"""

from ._api import Progress, Quantity, Source, mesh, read
from ._convert import from_geomdl, from_ocp, tessellate
from ._errors import Cancelled, Error, FileError, InternalError, RequestError
from ._native import (
    BezierPatch,
    Curve,
    Edge,
    Face,
    Instance,
    Mesh,
    Model,
    Node,
    Part,
    Polyline,
    Surface,
    Written,
    __version__,
)

__all__ = [
    "BezierPatch",
    "Cancelled",
    "Curve",
    "Edge",
    "Error",
    "Face",
    "FileError",
    "Instance",
    "InternalError",
    "Mesh",
    "Model",
    "Node",
    "Part",
    "Polyline",
    "Progress",
    "Quantity",
    "RequestError",
    "Source",
    "Surface",
    "Written",
    "__version__",
    "from_geomdl",
    "from_ocp",
    "mesh",
    "read",
    "tessellate",
]
