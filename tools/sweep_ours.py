"""One file meshed by the program, in a process of its own, and the measures of the mesh."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import threading
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

# A run that needs more memory than this is a fault, and ends.
ADDRESS_SPACE = 8 << 30


@dataclass
class Run:
    """What one run of the program says, and what its mesh measures. `exit` is None when the time was over."""

    exit: int | None
    seconds: float  # Of the processor: the wall time of a loaded machine says nothing.
    message: str
    report: dict | None = None
    area: float = 0.0
    volume: float = 0.0
    low: list[float] = field(default_factory=list)
    high: list[float] = field(default_factory=list)

    @property
    def memory(self) -> int:
        """Largest resident memory in bytes; 0 where there is no report."""
        return (self.report or {}).get("peak_memory") or 0

    @property
    def codes(self) -> Counter[str]:
        """Codes of the problems that are errors, and how often."""
        problems = self.report["problems"] if self.report else []
        return Counter(p["code"] for p in problems if p["severity"] == "error")

    @property
    def crossing(self) -> int:
        """Pairs of facets of closed shells that cut each other."""
        parts = self.report["parts"] if self.report else []
        return sum(s["triangle_pairs"] for part in parts for s in part["self_intersections"])


def run_ours(binary: Path, model: Path, tolerance: str, limit: float, folder: Path) -> Run:
    folder.mkdir(parents=True, exist_ok=True)
    mesh, report = folder / f"{model.stem}.ply", folder / f"{model.stem}.json"
    for path in (mesh, report):
        path.unlink(missing_ok=True)
    command = [binary, "mesh", model, "-o", mesh, "--report", report, "--tolerance", tolerance, "--jobs", "1"]
    run = timed(command, limit)
    if report.exists():
        run.report = json.loads(report.read_text(encoding="utf-8"))
    if mesh.exists():
        measure(run, mesh)
        mesh.unlink()
    return run


def timed(command: list[Path | str], limit: float) -> Run:
    """Seconds of the processor; what does not end within `limit` seconds of wall time is ended."""
    prefix = ["prlimit", f"--as={ADDRESS_SPACE}"]
    process = subprocess.Popen([*prefix, *command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    timer = threading.Timer(limit, process.kill)
    timer.start()
    errors = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    ended = not timer.is_alive() and process.returncode == -signal.SIGKILL
    timer.cancel()
    lines = errors.decode(errors="replace").strip().splitlines()
    seconds = usage.ru_utime + usage.ru_stime
    return Run(None if ended else process.returncode, seconds, lines[-1] if lines else "")


def measure(run: Run, mesh: Path) -> None:
    """Area, signed volume and box."""
    points, triangles = read_ply(mesh)
    if not len(triangles):
        return
    corners = points[triangles] - points.mean(axis=0)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sizes = 0.5 * np.linalg.norm(normals, axis=1)
    run.area = float(sizes.sum())
    run.volume = float(np.einsum("ij,ij->i", corners[:, 0], normals).sum() / 6)
    used = points[np.unique(triangles)]
    run.low, run.high = used.min(axis=0).tolist(), used.max(axis=0).tolist()


def read_ply(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of a PLY file of ours."""
    data = path.read_bytes()
    header, _, body = data.partition(b"end_header\n")
    counts = {w[1]: int(w[2]) for w in (line.split() for line in header.splitlines()) if w[:1] == [b"element"]}
    vertex = np.dtype([("p", "<f8", 3)])
    facet = [("n", "u1"), ("v", "<i4", 3), ("face", "<i4")]
    if b"property uchar red" in header:
        facet.append(("colour", "u1", 4))
    vertices = np.frombuffer(body, vertex, counts[b"vertex"])
    facets = np.frombuffer(body, np.dtype(facet), counts[b"face"], vertices.nbytes)
    return vertices["p"], facets["v"]
