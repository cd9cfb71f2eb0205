"""Measures the meshes of one model with the independent verifier; prints one JSON object a mesh, as a list.

    measure_one.py VERIFY.py MODEL MESH=REPORT.json [MESH=REPORT.json ...]

Runs in a process of its own, because the other kernel may crash or hang on a model. The verifier's reference is built
once for all meshes of the model. Beside what the verifier says, every face's sampled distance to the mesh is compared
with what our report proves for that face: `proven_error + gap`.
"""

from __future__ import annotations

import importlib.util
import json
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from occ_reading import StepFile

# Sampled distances carry the rounding of the other kernel's evaluators, relative to the size of the model.
ROUNDING = 1e-9


def load_verifier(path: str) -> ModuleType:
    """The verifier as a module, changed in two ways: the reader is kept, and the distances of its samples are."""
    spec = importlib.util.spec_from_file_location("verify", path)
    verify = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(verify)
    verify.files = []

    def load_step(model: str):
        verify.files.append(StepFile(model))
        return verify.files[-1].shape, verify.files[-1].doc

    class Recording(verify.MeshDist):
        """Keeps the answer to the largest query: the distances of all samples of the surfaces."""

        largest = np.zeros(0)

        def __call__(self, points):
            distance, triangle = super().__call__(points)
            if len(points) > len(Recording.largest):
                Recording.largest = distance
            return distance, triangle

    verify.load_step = load_step
    verify.MeshDist = Recording
    return verify


def measure(verify: ModuleType, reference: Any, origins: list[str | None], mesh: str, report: dict) -> dict:
    """One mesh of the model."""
    verify.MeshDist.largest = np.zeros(0)
    points, faces = verify.load_mesh(mesh)
    tolerance = report["options"]["tolerance"]
    result = verify.verify(reference, points, faces, tolerance)
    if "error" in result:
        return {"mesh": mesh, "error": result["error"]}
    distance = verify.MeshDist.largest
    if len(distance) == len(reference.P):
        result["per_face"] = compare_faces(reference, distance, origins, report)
    result["mesh"] = mesh
    return result


def compare_faces(reference: Any, distance: np.ndarray, origins: list[str | None], report: dict) -> dict:
    """Every face's largest sampled distance against its own bound, or the largest bound where its origin is unknown."""
    measured = np.zeros(len(reference.faces))
    np.maximum.at(measured, reference.F, distance)
    bounds, excused = bounds_by_entity(report)
    known = [b for b in bounds.values() if b is not None]
    widest = max(known, default=0.0)
    slack = ROUNDING * (reference.diag + float(np.abs(reference.P).max()))
    broken, unmatched, compared = [], 0, 0
    for face, (origin, value) in enumerate(zip(origins, measured)):
        if origin in excused:
            continue
        if origin not in bounds:
            unmatched += 1
        bound = bounds.get(origin, widest)
        if bound is None:
            continue
        compared += 1
        if value > bound + slack:
            broken.append({"face": face, "id": origin, "measured": float(value), "bound": bound})
    broken.sort(key=lambda b: -b["measured"] / max(b["bound"], 1e-300))
    missing = [origins[f] for f in np.flatnonzero(measured > 3 * report["options"]["tolerance"])]
    return {"compared": compared, "unmatched": unmatched, "broken": len(broken), "list": broken[:20],
            "over_3x": missing[:20]}


def bounds_by_entity(report: dict) -> tuple[dict[str, float | None], set[str]]:
    """The bound of every face entity, and the entities that the report already calls failed or of no area."""
    bounds: dict[str, float | None] = {}
    for face in report["face_list"]:
        proven, gap = face["proven_error"], face["gap"]
        bound = None if proven is None else proven + (gap or 0.0)
        if face["id"] in bounds and None not in (bounds[face["id"]], bound):
            bound = max(bound, bounds[face["id"]])
        bounds[face["id"]] = bound
    undone = report["faces"]["failed"] + report["faces"]["zero_area"]
    return bounds, {face["id"] for face in undone}


def main() -> None:
    verifier, model, *pairs = sys.argv[1:]
    verify = load_verifier(verifier)
    reference = verify.Reference(model)
    origins = verify.files[-1].entity_of_face()
    results = []
    for pair in pairs:
        mesh, report = pair.split("=")
        results.append(measure(verify, reference, origins, mesh, json.loads(Path(report).read_text())))
    print("\n" + json.dumps(results, default=float))


if __name__ == "__main__":
    main()
