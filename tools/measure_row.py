"""One line of the table: what a mesh is said to be, what it was measured to be, and which promises hold."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field

# Measured distances carry the other kernel's rounding: this much of the diagonal is forgiven.
ROUNDING = 1e-9

PROMISES = {
    "exit": "exit code 0 or 1",
    "faces": "as many faces as the index says, but for those that the other kernel splits",
    "failed": "no face failed",
    "missing": "the verifier finds no face missing",
    "closed": "every closed shell has 0 open and 0 inconsistent edges",
    "measured": "measured error at most tolerance + gap (the larger of ours and the other kernel's edge gap)",
    "proven": "proven error at most the tolerance where the exit code is 0",
    "per_face": "proven error + gap at least the measured error on every face (or + the distance of the file's own "
    "pcurves from its edges)",
}


@dataclass
class Row:
    """Lengths in mm. None: not known, because the step before did not get there."""

    model: str
    tolerance: str
    exit: int | None
    seconds: float
    message: str
    faces_index: int | None
    faces: int | None = None
    failed: int | None = None
    zero_area: int | None = None
    triangles: int | None = None
    lower_bound: float | None = None
    tolerance_mm: float | None = None
    proven_error: float | None = None
    gap: float | None = None
    occ_edge_gap: float | None = None
    occ_edge_tolerance: float | None = None
    s2m: float | None = None
    m2s: float | None = None
    missing: int | None = None
    open_edges: int | None = None
    inconsistent_edges: int | None = None
    shells_closed: int | None = None
    shells_watertight: int | None = None
    merged_open_edges: int | None = None
    faces_over_bound: int | None = None
    faces_over_by_pcurve: int | None = None
    faces_compared: int | None = None
    diagonal: float | None = None
    faces_split: int = 0
    verify_error: str = ""
    notes: list[str] = field(default_factory=list)
    reasons: Counter[str] = field(default_factory=Counter)

    @property
    def measured(self) -> float | None:
        return None if self.s2m is None or self.m2s is None else max(self.s2m, self.m2s)

    @property
    def ratio(self) -> float | None:
        return self.triangles / self.lower_bound if self.triangles is not None and self.lower_bound else None

    def promises(self) -> dict[str, bool | None]:
        """True: kept, False: broken, None: could not be judged."""
        if self.exit not in (0, 1):
            return dict.fromkeys(PROMISES) | {"exit": False}
        slack = ROUNDING * (self.diagonal or 0.0)
        measured = None
        if self.measured is not None:
            loose = max(self.gap or 0.0, self.occ_edge_gap or 0.0)
            measured = self.measured <= self.tolerance_mm + loose + slack
        proven = None
        if self.exit == 0:
            proven = self.proven_error is not None and self.proven_error <= self.tolerance_mm * (1 + 1e-12)
        return {
            "exit": True,
            "faces": None if self.faces_index is None else self.faces + self.faces_split == self.faces_index,
            "failed": self.failed == 0,
            "missing": None if self.missing is None else self.missing == 0,
            "closed": self.open_edges == 0
            and self.inconsistent_edges == 0
            and self.shells_closed == self.shells_watertight,
            "measured": measured,
            "proven": proven,
            "per_face": None
            if self.faces_over_bound is None
            else self.faces_over_bound == self.faces_over_by_pcurve,
        }

    def broken(self) -> list[str]:
        return [name for name, kept in self.promises().items() if kept is False]


def row_of(run, report: dict | None, measured: dict | None, faces_index: int | None) -> Row:
    """From a run of the binary, its report and the verifier's answer."""
    row = Row(run.model.name, run.tolerance, run.exit, run.seconds, run.message, faces_index)
    if report is not None:
        add_report(row, report)
    if measured is not None:
        add_measured(row, measured)
    return row


def add_report(row: Row, report: dict) -> None:
    faces = report["faces"]
    row.faces = faces["total"]
    row.failed = faces["failed"]
    row.zero_area = faces["zero_area"]
    row.triangles = report["triangles"]
    row.lower_bound = report["lower_bound"]
    row.tolerance_mm = report["options"]["tolerance"]
    row.proven_error = report["proven_error"]
    row.gap = report["max_edge_gap"]
    row.diagonal = report["input"]["diagonal"]
    row.open_edges = report["open_edges"]
    row.inconsistent_edges = report["inconsistent_edges"]
    row.shells_closed = report["shells"]["closed_in_file"]
    row.shells_watertight = report["shells"]["closed_in_file"] - report["shells"]["leaking"]
    for problem in report["problems"]:
        face = report["faces_detail"][problem["face"]] if problem["face"] is not None else None
        place = f"{problem['entity']} (line {problem['line']})"
        if face is not None and face["status"] != "meshed":
            place = f"{place[:-1]}, {face['kind']}, ×{face['instances']})"
        if face is not None and face["status"] == "failed":
            pattern = re.sub(r"[-#0-9.e+]*[0-9]", "…", problem["message"])
            row.reasons[f"{face['kind']}: {pattern}"] += face["instances"]
        if problem["severity"] == "error" or problem["code"] == "zero-area":
            row.notes.append(f"{place}: {problem['message']}")


def add_measured(row: Row, measured: dict) -> None:
    if "error" in measured:
        row.verify_error = measured["error"]
        return
    row.occ_edge_gap = measured["model_edge_gap"]
    row.occ_edge_tolerance = measured["model_max_edge_tol"]
    row.s2m = measured["s2m"]["max"]
    row.m2s = measured["m2s"]["max"]
    row.missing = measured["faces"]["missing"]
    row.diagonal = row.diagonal or measured["diag"]
    row.merged_open_edges = measured["topology_exact"]["boundary_edges"]
    per_face = measured.get("per_face")
    if per_face is not None:
        row.faces_over_bound = per_face["broken"]
        row.faces_compared = per_face["compared"]
        explain_faces(row, per_face["replaced"])
        row.faces_over_by_pcurve = per_face.get("explained", sum(b["explained"] for b in per_face["list"]))
        row.notes += [
            f"over its bound: {b['id']} (the other kernel's face {b['face']}): measured {b['measured']:.4g}, "
            f"bound {b['bound']:.4g}; the file's pcurves are {b['pcurve_gap']:.4g} off their edges"
            for b in per_face["list"]
        ]


def explain_faces(row: Row, replaced: dict) -> None:
    """The other kernel splits some faces that wind round their surface; its index counts the pieces."""
    ours, theirs = replaced["ours"], replaced["theirs"]
    difference = theirs - sum(ours.values())
    if row.faces is not None and row.faces != row.faces_index and row.faces + difference == row.faces_index:
        row.faces_split = difference
        row.notes.append(
            f"the index counts {difference} faces more: the other kernel made {theirs} of {', '.join(ours)}"
        )
