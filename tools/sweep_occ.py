#!/usr/bin/env python3
"""Prints the exact properties of a STEP or IGES file as OpenCASCADE reads it, one JSON object a line.

    tools/sweep_occ.py FILE
    tools/sweep_occ.py --serve    (one JSON request a line, see `serve`)

Lines come as soon as something is known, so that a process that is ended loses only the rest: counts (faces,
solids, closed and open shells, free faces, `all_closed`: every face belongs to a closed shell), areas of the
faces by entity, area and accuracy, box, volume, faces that OpenCASCADE's own check calls invalid.
Lengths are millimetres; faces are counted as placed.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import time
from collections.abc import Iterable
from pathlib import Path
from typing import NoReturn

if __name__ == "__main__" and {"-h", "--help"} & set(sys.argv[1:]):
    # Before OpenCASCADE, which may not be installed.
    print(__doc__)
    sys.exit(0)

from occ_reading import StepFile, explore_faces
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.IGESControl import IGESControl_Reader
from OCP.TopAbs import TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS_Compound, TopoDS_Shape

# Relative accuracy of areas and volumes.
ACCURACY = 1e-4


def main() -> int:
    if sys.argv[1:] == ["--serve"]:
        serve()
        return 0
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 2
    examine(Path(sys.argv[1]))
    return 0


def serve() -> None:
    """Answers requests from standard input, each in a child process: loading the kernel takes longer than most
    files."""
    for line in sys.stdin:
        request = json.loads(line)
        child = os.fork()
        if child == 0:
            answer(request)
        print(json.dumps({"ended": ended(child, request["limit"])}), flush=True)


def answer(request: dict) -> NoReturn:
    out = os.open(request["out"], os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    os.dup2(out, 1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    try:
        examine(Path(request["path"]))
    except BaseException as error:  # The child must not return into the server's loop.
        say(error=str(error))
        os._exit(1)
    os._exit(0)


def ended(child: int, limit: float) -> str:
    """How a child ended; "" if well."""
    start = time.monotonic()
    while True:
        pid, status = os.waitpid(child, os.WNOHANG)
        if pid:
            return "" if status == 0 else f"status {status}"
        if time.monotonic() - start > limit:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            return f"over {limit:g} s"
        time.sleep(0.01)


def examine(path: Path) -> None:
    shape, entities = read(path)
    faces = explore_faces(shape)
    say(**counts(shape, faces))
    areas = [area_of(face) for face in faces]
    say(area=sum(abs(area) for area in areas), areas=by_entity(entities, areas))
    say(box=box_of(shape))
    say(volume=volume_of(shape))
    say(invalid=[e for e, face in zip(entities, faces) if not BRepCheck_Analyzer(face).IsValid()])
    say(valid=BRepCheck_Analyzer(shape).IsValid())


def say(**what) -> None:
    print(json.dumps(what), flush=True)


def read(path: Path) -> tuple[TopoDS_Shape, list[str | None]]:
    """The shape, and the entity of each of its faces where it is known."""
    if path.suffix.lower() in {".igs", ".iges"}:
        reader = IGESControl_Reader()
        if reader.ReadFile(str(path)) != IFSelect_RetDone:
            raise ValueError("not read")
        reader.TransferRoots()
        shape = reader.OneShape()
        shape = TopoDS_Compound() if shape.IsNull() else shape
        return shape, [None] * len(explore_faces(shape)) if not shape.IsNull() else []
    file = StepFile(path)
    return file.shape, file.entity_of_face()


def counts(shape: TopoDS_Shape, faces: list) -> dict:
    shells = list(explored(shape, TopAbs_SHELL))
    closed = [shell for shell in shells if BRep_Tool.IsClosed_s(shell)]
    in_closed = sum(len(explore_faces(shell)) for shell in closed)
    return {
        "faces": len(faces),
        "solids": sum(1 for _ in explored(shape, TopAbs_SOLID)),
        "closed_shells": len(closed),
        "open_shells": len(shells) - len(closed),
        "all_closed": in_closed == len(faces),
    }


def explored(shape: TopoDS_Shape, kind) -> Iterable[TopoDS_Shape]:
    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def area_of(face) -> float:
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, properties, ACCURACY)
    return properties.Mass()


def by_entity(entities: list[str | None], areas: list[float]) -> dict[str, float]:
    """The largest placement of each face."""
    largest: dict[str, float] = {}
    for entity, area in zip(entities, areas):
        if entity is not None:
            largest[entity] = max(abs(area), largest.get(entity, 0.0))
    return largest


def box_of(shape: TopoDS_Shape) -> list[float]:
    """The tight box of the faces: wires that belong to no face do not count."""
    builder, only_faces = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(only_faces)
    for face in explored(shape, TopAbs_FACE):
        builder.Add(only_faces, face)
    box = Bnd_Box()
    BRepBndLib.AddOptimal_s(only_faces, box, False, False)
    if box.IsVoid():
        return []
    low, high = box.CornerMin(), box.CornerMax()
    return [low.X(), low.Y(), low.Z(), high.X(), high.Y(), high.Z()]


def volume_of(shape: TopoDS_Shape) -> float:
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties, ACCURACY, False)
    return properties.Mass()


if __name__ == "__main__":
    sys.exit(main())
