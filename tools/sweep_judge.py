"""What is wrong with one file of a sweep, from both sides' answers."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from sweep_files import Entry
from sweep_ours import Run

# Area, volume and box may differ by this much: the mesh is as coarse as its tolerance allows.
AGREE = 0.01
# A face differs when its area is off by this much of itself and by that much of the whole area.
FACE_ITSELF, FACE_OF_WHOLE = 0.05, 1e-3
# Seconds of the processor.
SLOW = 20.0


@dataclass
class Verdict:
    """`kinds`: what is wrong; empty for a clean file. Ratios are ours over theirs, None where one is not known."""

    entry: Entry
    ours: Run
    theirs: dict
    kinds: list[str] = field(default_factory=list)
    area_ratio: float | None = None
    volume_ratio: float | None = None
    box_difference: float | None = None
    differing: list[str] = field(default_factory=list)
    no_faces: bool = False
    finer: Run | None = None

    @property
    def name(self) -> str:
        return self.entry.name

    @property
    def differs(self) -> bool:
        """A measure differs from theirs."""
        ratios = (self.area_ratio, self.volume_ratio)
        return any(map(off, ratios)) or (self.box_difference or 0.0) > AGREE or bool(self.differing)

    @property
    def clean(self) -> bool:
        return not self.kinds

    @property
    def words(self) -> str:
        if self.no_faces:
            return "no faces"
        return "; ".join(self.kinds) or "clean"


def judge(entry: Entry, ours: Run, theirs: dict, finer: Run | None = None) -> Verdict:
    """`finer`: a mesh with a smaller tolerance, which is compared in place of the first one."""
    verdict = Verdict(entry, ours, theirs, finer=finer if finer and finer.report else None)
    if ours.exit == 2 and not theirs.get("faces"):
        verdict.no_faces = True
        return verdict
    verdict.kinds += of_run(ours)
    if ours.report is not None:
        verdict.kinds += of_shells(ours, theirs)
        compare(verdict)
    return verdict


def of_run(ours: Run) -> list[str]:
    kinds = []
    if ours.exit is None:
        kinds.append("did not end")
    elif ours.exit == 2:
        kinds.append(f"nothing written: {ours.message}")
    elif ours.exit not in (0, 1):
        kinds.append(f"crash: exit {ours.exit}: {ours.message}")
    elif ours.exit == 1:
        kinds.append("exit 1: " + ", ".join(f"{n} {code}" for code, n in sorted(ours.codes.items())))
    if ours.seconds > SLOW:
        kinds.append(f"slow: {ours.seconds:.0f} s")
    if ours.crossing:
        kinds.append(f"facets cross: {ours.crossing} pairs")
    return kinds


def of_shells(ours: Run, theirs: dict) -> list[str]:
    """A closed shell of theirs that is not closed in our mesh; shells are those of the file in STEP only."""
    shells = ours.report["shells"]
    closed = theirs.get("closed_shells", 0)
    if shells["leaking"]:
        return [f"leaks: {shells['leaking']} of {shells['closed_in_file']} closed shells"]
    if shells["closed"] < closed:
        return [f"closed shells: {shells['closed']}, theirs {closed}"]
    return []


def compare(verdict: Verdict) -> None:
    ours, theirs = verdict.finer or verdict.ours, verdict.theirs
    verdict.area_ratio = ratio(ours.area, theirs.get("area"))
    if off(verdict.area_ratio):
        verdict.kinds.append(f"area {verdict.area_ratio:.4g}")
    if theirs.get("all_closed") and ours.report["closedness"] == "closed":
        verdict.volume_ratio = ratio(ours.volume, theirs.get("volume"))
        if off(verdict.volume_ratio):
            verdict.kinds.append(f"volume {verdict.volume_ratio:.4g}")
    compare_boxes(verdict)
    verdict.differing = differing_faces(ours.report, theirs)
    if verdict.differing:
        verdict.kinds.append(f"{len(verdict.differing)} faces differ")
    if theirs.get("faces") == 0 and ours.report["faces"]["total"]:
        verdict.kinds.append("faces that theirs has not")


def ratio(ours: float, theirs: float | None) -> float | None:
    return ours / theirs if theirs else None


def off(value: float | None) -> bool:
    return value is not None and not abs(value - 1) <= AGREE


def compare_boxes(verdict: Verdict) -> None:
    ours = verdict.finer or verdict.ours
    box, low, high = verdict.theirs.get("box"), ours.low, ours.high
    if not box or not low:
        return
    diagonal = math.dist(box[:3], box[3:])
    worst = max(abs(a - b) for a, b in zip([*low, *high], box))
    verdict.box_difference = worst / diagonal if diagonal > 0 else math.inf
    if verdict.box_difference > AGREE:
        verdict.kinds.append(f"box off by {verdict.box_difference:.2g} of the diagonal")


def differing_faces(report: dict, theirs: dict) -> list[str]:
    """Faces whose area differs, as `#entity ours/theirs`, the worst first."""
    areas, whole = theirs.get("areas") or {}, theirs.get("area") or 0.0
    found = []
    for face in report["faces_detail"]:
        exact = areas.get(face["entity"])
        if exact is None or face["instances"] == 0 or face.get("area") is None:
            continue
        difference = abs(face["area"] - exact)
        if difference > FACE_ITSELF * exact and difference > FACE_OF_WHOLE * whole:
            found.append((difference, f"{face['entity']} {face['area']:.6g}/{exact:.6g}"))
    return [words for _, words in sorted(found, reverse=True)]
