"""Measures the meshes of one model with an independent verifier: what tools/measure_one.py runs.

The verifier's reference is built once for all meshes of the model. Beside what the verifier says, the sampled
distance of every face to the mesh is compared with what our report proves for that face: `proven_error +
gap`.
"""

from __future__ import annotations

import importlib.util
from types import ModuleType
from typing import Any

import numpy as np
from occ_reading import StepFile

# Sampled distances carry the rounding of the other kernel's evaluators, relative to the size of the model.
ROUNDING = 1e-9


def load_verifier(path: str) -> ModuleType:
    """The verifier as a module, with four changes: the reader is kept, so are the distances of its samples,
    feet are found on the inner part of a spindle torus and beyond the apex of a cone, and the other kernel's
    own search over the whole shape has the last word on points that look too far."""
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

    near_foot = verify.FaceRef.project

    def project(face, points, uv):
        return far_foot(verify, face, points) if on_far_side(verify, face) else near_foot(face, points, uv)

    near_seeds = verify.Reference.multi_seed

    def multi_seed(reference, point, k=200):
        found = near_seeds(reference, point, k)
        return found if found <= verify.suspect else min(found, whole_shape(verify, reference, point))

    verify.suspect = float("inf")
    verify.Reference.multi_seed = multi_seed
    verify.FaceRef.project = project
    verify.load_step = load_step
    verify.MeshDist = Recording
    return verify


def whole_shape(verify: ModuleType, reference: Any, point: np.ndarray) -> float:
    """The distance of a point from all faces, by the other kernel."""
    vertex = verify.BRepBuilderAPI_MakeVertex(verify.gp_Pnt(*map(float, point))).Vertex()
    search = verify.BRepExtrema_DistShapeShape(vertex, reference.shape)
    return float(search.Value()) if search.IsDone() else float("inf")


def on_far_side(verify: ModuleType, face: Any) -> bool:
    """Whether a face lies on the inner part of a spindle torus or on the cone's nappe beyond the apex: where
    the signed distance from the axis, as a function of v, is negative."""
    middle = 0.5 * (face.uv[2] + face.uv[3])
    if face.typ == verify.GeomAbs_Torus:
        return face.par[0] + face.par[1] * np.cos(middle) < 0
    return face.typ == verify.GeomAbs_Cone and face.par[0] + middle * np.sin(face.par[1]) < 0


def far_foot(verify: ModuleType, face: Any, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parameters of the nearest points on that part, and their distances."""
    origin, x_axis, y_axis, z_axis = face.ax
    x, y, z = ((points - origin) @ axis for axis in (x_axis, y_axis, z_axis))
    u, radius = np.mod(np.arctan2(-y, -x), 2 * np.pi), -np.hypot(x, y)
    if face.typ == verify.GeomAbs_Torus:
        ring, tube = face.par
        v = np.mod(np.arctan2(z, radius - ring), 2 * np.pi)
        return np.c_[u, v], np.abs(np.hypot(radius - ring, z) - tube)
    at_origin, angle = face.par
    v = (radius - at_origin) * np.sin(angle) + z * np.cos(angle)
    distance = np.abs((radius - at_origin) * np.cos(angle) - z * np.sin(angle))
    return np.c_[u, v], np.where(at_origin + v * np.sin(angle) > 0, np.inf, distance)


def measure(verify: ModuleType, reference: Any, origins: list[str | None], mesh: str, report: dict) -> dict:
    """One mesh of the model."""
    verify.MeshDist.largest = np.zeros(0)
    points, faces = verify.load_mesh(mesh)
    verify.suspect = report["options"]["tolerance"] + report["max_edge_gap"]
    # A face counts as missing when it is three times this away: the looseness of the file is no missing face.
    result = verify.verify(reference, points, faces, report["options"]["tolerance"] + report["max_edge_gap"])
    if "error" in result:
        return {"mesh": mesh, "error": result["error"]}
    distance = verify.MeshDist.largest
    if len(distance) == len(reference.P):
        result["per_face"] = compare_faces(reference, distance, origins, report)
    result["mesh"] = mesh
    return result


def compare_faces(reference: Any, distance: np.ndarray, origins: list[str | None], report: dict) -> dict:
    """Every face's largest sampled distance against its own bound, or the largest bound where its origin is
    unknown."""
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
            loose = pcurve_gap(reference, face)
            broken.append(
                {
                    "face": face,
                    "id": origin,
                    "measured": float(value),
                    "bound": bound,
                    "pcurve_gap": loose,
                    "explained": bool(value <= bound + loose + slack),
                }
            )
    broken.sort(key=lambda b: -b["measured"] / max(b["bound"], 1e-300))
    missing = [origins[f] for f in np.flatnonzero(measured > 3 * report["options"]["tolerance"])]
    explained = sum(b["explained"] for b in broken)
    return {
        "compared": compared,
        "unmatched": unmatched,
        "broken": len(broken),
        "explained": explained,
        "list": broken[:20],
        "over_3x": missing[:20],
        "replaced": replaced(origins, report),
    }


def pcurve_gap(reference: Any, face: int) -> float:
    """How far the face's pcurves, lifted to its surface, lie from the 3D curves of its edges: what the file
    is loose by."""
    worst = 0.0
    for i in np.flatnonzero((reference.F == face) & (reference.E >= 0)):
        p = reference.edges[reference.E[i]][1].Value(float(reference.T[i]))
        worst = max(worst, float(np.linalg.norm(reference.P[i] - (p.X(), p.Y(), p.Z()))))
    return worst


def replaced(origins: list[str | None], report: dict) -> dict:
    """Faces of ours that the other kernel did not keep as they are, and how many faces of unknown origin it
    has."""
    known = set(origins)
    lost = {face["entity"]: face["instances"] for face in report["faces_detail"] if face["entity"] not in known}
    return {"ours": lost, "theirs": origins.count(None)}


def bounds_by_entity(report: dict) -> tuple[dict[str, float | None], set[str]]:
    """The bound of every face entity, and the entities that the report already calls failed or of no area."""
    bounds: dict[str, float | None] = {}
    for face in report["faces_detail"]:
        proven, gap = face["proven_error"], face["gap"]
        bound = None if proven is None else proven + (gap or 0.0)
        if face["entity"] in bounds and None not in (bounds[face["entity"]], bound):
            bound = max(bound, bounds[face["entity"]])
        bounds[face["entity"]] = bound
    undone = [face for face in report["faces_detail"] if face["status"] != "meshed"]
    return bounds, {face["entity"] for face in undone}
