"""Reading and meshing: what most users call."""

from __future__ import annotations

import json
import logging
import math
import os
from collections.abc import Callable
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, TypedDict, Union

from . import _native
from ._errors import RequestError
from ._native import Mesh, Model

if TYPE_CHECKING:
    from typing_extensions import Unpack

_log = logging.getLogger("chordal")
_log.addHandler(logging.NullHandler())

_LEVELS = {"error": logging.ERROR, "warning": logging.WARNING, "note": logging.INFO}

Source = Union[str, "os.PathLike[str]", bytes, bytearray, memoryview, IO[bytes]]
"""A path, the bytes of a file, or an open binary file."""

Progress = Callable[[str, float], Union[bool, None]]
"""Called with the phase and the fraction of it that is done, in the calling thread; `False` cancels."""

Quantity = Union[float, str]
"""Millimetres or degrees as a number, or a text with a unit: `"0.05mm"`, `"0.1%"`, `"20deg"`."""


class MeshOptions(TypedDict, total=False):
    """The options of `mesh`: those of `read` and of `Model.mesh`."""

    format: str | None
    name: str | None
    winding: str | None
    angle: Quantity | None
    max_edge: Quantity | None
    boundary_tolerance: Quantity | None
    sew: Quantity | None
    bound: str | None
    strategy: str | None
    edge_method: str | None
    output_format: str | None
    self_intersections: bool | None
    face_timeout: float | None
    file_timeout: float | None
    memory: int | None
    threads: int | None
    progress: Progress | None
    tol_linear: float | None
    tol_angular: float | None
    tol_relative: bool | None


class _Unset:
    def __repr__(self) -> str:
        return "20"


_UNSET = _Unset()


def read(
    source: Source,
    format: str | None = None,
    *,
    name: str | None = None,
    winding: str | None = None,
    progress: Progress | None = None,
) -> Model:
    """Reads a CAD file: a path, its bytes, or an open binary file.

    The format is recognised by content unless `format` names it: `step`, `iges`, `brep`, `3dm`, `inventor`,
    `x3d`, `obj`, `json`. `name` names bytes in messages,
    and the model where the file gives it no name.
    """
    if isinstance(source, (str, os.PathLike)):
        return _native.read(os.fspath(source), None, "", format, winding, progress)
    if isinstance(source, (bytes, bytearray, memoryview)):
        content, title = bytes(source), "model"
    elif hasattr(source, "read"):
        content, title = source.read(), Path(str(getattr(source, "name", "model"))).stem
        if not isinstance(content, bytes):
            raise RequestError("source: a file must be open in binary mode")
    else:
        raise TypeError(f"source: a path, bytes or a binary file is needed, not {type(source).__name__}")
    return _native.read(None, content, name or title, format, winding, progress)


def mesh_model(
    model: Model,
    tolerance: Quantity | None = None,
    angle: Quantity | None | _Unset = _UNSET,
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
    """`Model.mesh`; the stub of the class documents it."""
    options: dict[str, Any] = {
        "tolerance": _tolerance(tolerance, tol_linear, tol_relative),
        "max_edge": max_edge,
        "boundary_tolerance": boundary_tolerance,
        "sew": sew,
        "bound": bound,
        "strategy": strategy,
        "edge_method": edge_method,
        "output_format": output_format,
        "self_intersections": self_intersections,
        "face_timeout": face_timeout,
        "file_timeout": file_timeout,
        "memory": memory,
    }
    if tol_angular is not None:
        if not isinstance(angle, _Unset):
            raise RequestError("tol_angular: it is another name of angle; give one of the two")
        options["angle"] = math.degrees(tol_angular)
    elif not isinstance(angle, _Unset):
        options["angle"] = angle
    mesh = model.mesh_with(options, threads, progress)
    _tell(model, mesh)
    return mesh


def mesh(
    source: Source | Model, tolerance: Quantity | None = None, **options: Unpack[MeshOptions]
) -> Mesh:
    """Reads a file and meshes it: `read` and `Model.mesh` in one go, with the options of both."""
    given: dict[str, Any] = dict(options)
    reading = {key: given.pop(key) for key in ("format", "name", "winding") if key in given}
    if isinstance(source, Model):
        if reading:
            raise RequestError(f"{next(iter(reading))}: it has no effect on a model that is read already")
        return mesh_model(source, tolerance, **given)
    model = read(source, progress=options.get("progress"), **reading)
    return mesh_model(model, tolerance, **given)


def _tolerance(tolerance: Quantity | None, linear: float | None, relative: bool | None) -> Quantity | None:
    if linear is None:
        if relative is not None:
            raise RequestError("tol_relative: it has no effect without tol_linear")
        return tolerance
    if tolerance is not None:
        raise RequestError("tol_linear: it is another name of tolerance; give one of the two")
    return f"{linear * 100!r}%" if relative else linear


def _tell(model: Model, mesh: Mesh) -> None:
    """The result and the problems, as log records."""
    if _log.isEnabledFor(logging.ERROR):
        for severity, sentence in mesh.problem_sentences():
            _log.log(_LEVELS[severity], "%s: %s", model.source, sentence)
        _log.info("%r", mesh)


def info_of(model: Model) -> dict[str, Any]:
    """`Model.info`."""
    found: dict[str, Any] = json.loads(model.info_json())
    return found


def problems_of(model: Model) -> list[dict[str, Any]]:
    """`Model.problems`."""
    found: list[dict[str, Any]] = json.loads(model.problems_json())
    return found
