#!/usr/bin/env python3
"""Which faces OpenCASCADE itself leaves without triangles, and which have no area: to judge our failed faces
by.

    tools/occ_faces.py MODEL [MODEL ...] [--deflection 0.1%] [--reports out/models]

Prints one tab-separated line a face: model, entity, instances, what (unmeshed, zero area), area in mm², area
over the square of the diagonal. With --reports it adds a line for each face that our report calls failed: `we
fail` where OpenCASCADE fails too or the face has no area, `only we fail` where it does not.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from arguments import parser_of

# The kernel is imported where it is used, so that --help needs none.
if TYPE_CHECKING:
    from occ_reading import StepFile
    from OCP.TopoDS import TopoDS_Face

# A face has no area when its mean width (twice the area over the perimeter) is below this part of the
# diagonal: the coordinates of a file seldom hold more digits.
NO_WIDTH = 1e-7


@dataclass(frozen=True)
class Finding:
    entity: str
    what: str
    area: float


def examine(model: Path, deflection: str) -> tuple[Counter[Finding], float]:
    """Faces without triangles or area, with their numbers of instances; and the diagonal."""
    from occ_reading import StepFile
    from OCP.BRep import BRep_Tool
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopLoc import TopLoc_Location

    file = StepFile(model)
    diagonal = diagonal_of(file)
    absolute = diagonal * float(deflection[:-1]) / 100 if deflection.endswith("%") else float(deflection)
    BRepMesh_IncrementalMesh(file.shape, absolute, False, 0.5, False)
    found: Counter[Finding] = Counter()
    for face, entity in zip(file.faces(), file.entity_of_face()):
        area = area_of(face)
        triangulation = BRep_Tool.Triangulation_s(face, TopLoc_Location())
        if 2 * area <= NO_WIDTH * diagonal * perimeter_of(face):
            found[Finding(entity or "?", "zero area", area)] += 1
        if triangulation is None or triangulation.NbTriangles() == 0:
            found[Finding(entity or "?", "unmeshed", area)] += 1
    return found, diagonal


def diagonal_of(file: StepFile) -> float:
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib

    box = Bnd_Box()
    BRepBndLib.AddOptimal_s(file.shape, box, False, False)
    return box.CornerMin().Distance(box.CornerMax())


def area_of(face: TopoDS_Face) -> float:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, properties)
    return abs(properties.Mass())


def perimeter_of(face: TopoDS_Face) -> float:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.LinearProperties_s(face, properties)
    return properties.Mass()


def failed_by_us(reports: Path, model: Path) -> dict[str, str]:
    """Entity and reason of every face that a report of the model calls failed."""
    failed: dict[str, str] = {}
    for path in sorted(reports.glob(f"{model.name}.*.json")):
        report = json.loads(path.read_text())
        if "faces" in report:
            failed |= {p["entity"]: p["message"] for p in report["problems"] if p["face"] is not None and p["severity"] == "error"}
    return failed


def main() -> int:
    parser = parser_of(__doc__)
    parser.add_argument("models", nargs="+", type=Path)
    parser.add_argument(
        "--deflection", default="0.1%", help="mm, or a percentage of the diagonal (default 0.1%%)"
    )
    parser.add_argument("--reports", type=Path, help="folder of our reports, as measure_models.py leaves it")
    args = parser.parse_args()
    only_we = 0
    for model in args.models:
        found, diagonal = examine(model, args.deflection)
        for finding, instances in found.items():
            print(
                model.name,
                finding.entity,
                instances,
                finding.what,
                f"{finding.area:.6g}",
                f"{finding.area / diagonal**2:.3g}",
                sep="\t",
            )
        excused = {finding.entity for finding in found}
        for entity, reason in (failed_by_us(args.reports, model) if args.reports else {}).items():
            only_we += entity not in excused
            print(
                model.name, entity, "", "we fail" if entity in excused else "only we fail", reason, sep="\t"
            )
    return 1 if only_we else 0


if __name__ == "__main__":
    sys.exit(main())
