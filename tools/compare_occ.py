#!/usr/bin/env python3
"""Times reading and meshing against OpenCASCADE: CPU seconds of one thread, warmed, by turns.

    tools/compare_occ.py MODELS [--only PATTERN] [--binary PROGRAM] [--tolerance 0.1%] [--out out/tables]

Writes speed.tsv and speed.md into --out. Needs cadquery-ocp (tools/requirements.txt).

OpenCASCADE: STEPCAFControl_Reader (read and transfer) + BRepMesh_IncrementalMesh(shape, deflection, False,
0.5, False). Ours: `chordal bench` at the same absolute deflection and `--angle` of 0.5 rad. A file is run by
each side by turns; the medians are compared. Start-up (an empty run of each) is measured apart and is in
neither.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import math
import os
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from arguments import add_binary, add_models, add_out, parser_of

ANGLE = 0.5
SUFFIXES = {".step", ".stp"}
# Long files are run less often: seconds of one run of the slower side -> turns.
TURNS = ((0.5, 7), (2.0, 5), (5.0, 3), (math.inf, 2))


@dataclass
class Timing:
    """CPU seconds of one side, one entry a run."""

    read: list[float] = field(default_factory=list)
    mesh: list[float] = field(default_factory=list)
    triangles: int = 0

    @property
    def total(self) -> float:
        return statistics.median(r + m for r, m in zip(self.read, self.mesh))


@dataclass
class Pair:
    model: str
    faces: int
    deflection: float
    ours: Timing
    occ: Timing
    error: str = ""

    @property
    def ratio(self) -> float:
        return self.occ.total / self.ours.total


def main() -> int:
    args = arguments()
    models = sorted(
        p
        for p in args.models.iterdir()
        if p.suffix.lower() in SUFFIXES and any(fnmatch.fnmatch(p.name, pattern) for pattern in args.only)
    )
    pairs, errors = [], []
    for model in models:
        try:
            pair = compare(args.binary, model, args.tolerance)
        except (RuntimeError, subprocess.TimeoutExpired, ValueError) as error:
            errors.append(f"{model.name}: {error}")
            print(errors[-1], file=sys.stderr, flush=True)
            continue
        pairs.append(pair)
        print(
            f"{model.name}: {pair.occ.total:.3f} / {pair.ours.total:.3f} = {pair.ratio:.1f}",
            file=sys.stderr,
            flush=True,
        )
    args.out.mkdir(parents=True, exist_ok=True)
    text = markdown(pairs, errors, startups(args.binary), args.tolerance)
    (args.out / "speed.md").write_text(text, encoding="utf-8")
    (args.out / "speed.tsv").write_text(tsv(pairs), encoding="utf-8")
    return 0 if pairs and not errors else 1


def arguments() -> argparse.Namespace:
    parser = parser_of(__doc__)
    add_models(parser)
    parser.add_argument("--only", nargs="+", default=["*"], help="shell patterns of file names")
    add_binary(parser)
    parser.add_argument("--tolerance", default="0.1%")
    add_out(parser, "out/tables", "folder for the tables")
    return parser.parse_args()


def compare(binary: Path, model: Path, tolerance: str) -> Pair:
    """Both sides by turns; the first run of each is the warming and is not counted."""
    first = run_ours(binary, model, tolerance)
    deflection = first["tolerance"]
    exact = f"{deflection!r}mm"
    ours, occ = Timing(), Timing()
    warm, faces = run_occ(model, deflection, Timing())
    turns = next(n for limit, n in TURNS if max(warm, first["read"][0] + first["mesh"][0]) <= limit)
    for _ in range(turns):
        run_occ(model, deflection, occ)
        answer = run_ours(binary, model, exact)
        ours.read += answer["read"]
        ours.mesh += answer["mesh"]
        ours.triangles = answer["triangles"]
    return Pair(model.name, faces, deflection, ours, occ)


def run_ours(binary: Path, model: Path, tolerance: str) -> dict:
    """One process: a run to warm up, and one that counts."""
    command = [
        binary,
        "bench",
        model,
        "--warm",
        "1",
        "--repeat",
        "1",
        "--tolerance",
        tolerance,
        "--angle",
        f"{ANGLE!r}rad",
        "--jobs",
        "1",
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        raise RuntimeError((done.stderr.strip().splitlines() or ["no message"])[-1])
    return json.loads(done.stdout)[0]


def run_occ(model: Path, deflection: float, timing: Timing) -> tuple[float, int]:
    """One run in this process; returns its CPU seconds and the number of faces."""
    # Imported here, so that --help needs no kernel. The first run warms up and is not counted.
    from occ_reading import StepFile
    from OCP.BRep import BRep_Tool
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopLoc import TopLoc_Location

    started = time.process_time()
    file = StepFile(model)
    was_read = time.process_time()
    BRepMesh_IncrementalMesh(file.shape, deflection, False, ANGLE, False)
    meshed = time.process_time()
    timing.read.append(was_read - started)
    timing.mesh.append(meshed - was_read)
    faces = file.faces()
    timing.triangles = sum(
        t.NbTriangles() for f in faces if (t := BRep_Tool.Triangulation_s(f, TopLoc_Location())) is not None
    )
    return meshed - started, len(faces)


def startups(binary: Path) -> dict[str, float]:
    """CPU seconds of starting each side and doing nothing."""
    occ = [
        sys.executable,
        "-c",
        "from OCP.STEPCAFControl import STEPCAFControl_Reader; STEPCAFControl_Reader()",
    ]
    return {"chordal": startup([binary, "--version"]), "OpenCASCADE in Python": startup(occ)}


def startup(command: Sequence[str | Path]) -> float:
    seconds = []
    for _ in range(5):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command, capture_output=True, env=os.environ)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return statistics.median(seconds)


def tsv(pairs: Sequence[Pair]) -> str:
    """The table that tools/plot_results.py draws."""
    names = [
        "model",
        "faces",
        "deflection_mm",
        "occ_read",
        "occ_mesh",
        "our_read",
        "our_mesh",
        "ratio",
        "occ_triangles",
        "our_triangles",
    ]
    lines = ["\t".join(names)]
    for p in sorted(pairs, key=lambda p: p.ratio):
        seconds = [statistics.median(t) for t in (p.occ.read, p.occ.mesh, p.ours.read, p.ours.mesh)]
        cells = [p.model, p.faces, p.deflection, *seconds, p.ratio, p.occ.triangles, p.ours.triangles]
        lines.append("\t".join(map(str, cells)))
    return "\n".join(lines) + "\n"


def markdown(pairs: Sequence[Pair], errors: Sequence[str], started: dict[str, float], tolerance: str) -> str:
    ratios = [p.ratio for p in pairs]
    mean = math.exp(statistics.fmean(map(math.log, ratios))) if ratios else math.nan
    lines = [
        "# Read and mesh, one thread, against OpenCASCADE 7.9",
        "",
        f"CPU seconds in process, medians of warmed runs by turns, deflection {tolerance} of the diagonal (the same number "
        "of mm for both), 0.5 rad.",
        "",
        f"- geometric mean of the ratios: **{mean:.2f}**",
        f"- smallest ratio: **{min(ratios, default=math.nan):.2f}**"
        + (f" ({min(pairs, key=lambda p: p.ratio).model})" if pairs else ""),
        f"- files: {len(pairs)}, slower than OpenCASCADE: {sum(r < 1 for r in ratios)}",
        f"- sums: OpenCASCADE {sum(p.occ.total for p in pairs):.2f} s, ours {sum(p.ours.total for p in pairs):.2f} s",
        "- start-up, in neither: " + ", ".join(f"{name} {value:.3f} s" for name, value in started.items()),
        "",
        "| file | faces | deflection mm | OCC read | OCC mesh | our read | our mesh | ratio | OCC triangles | our triangles |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for p in sorted(pairs, key=lambda p: p.ratio):
        cells = [
            p.model,
            str(p.faces),
            f"{p.deflection:.4g}",
            *(f"{statistics.median(t):.4f}" for t in (p.occ.read, p.occ.mesh, p.ours.read, p.ours.mesh)),
            f"{p.ratio:.2f}",
            str(p.occ.triangles),
            str(p.ours.triangles),
        ]
        lines.append("| " + " | ".join(cells) + " |")
    if errors:
        lines += ["", "Not compared:", "", *(f"- {e}" for e in errors)]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main())
