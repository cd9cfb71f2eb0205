"""Meshes models whose right areas are known, and lists those that are not right.

    python corpus/make/check_variants.py target/release/chordal FOLDER [--tolerance 0.1%]... [--kind NAME]...

FOLDER holds an INDEX.tsv with the columns file, tests and area, as the makers of the corpus write it. A model
is right with exit code 0, its area within 1 % and less than two seconds of CPU.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

NEAR = 0.01
SECONDS = 2.0
GIVE_UP = 10


def limit_work() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (GIVE_UP, GIVE_UP))


def fault(program: str, model: Path, right: float, tolerance: str) -> str | None:
    """What is wrong with the mesh of a model, if anything."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [program, "mesh", str(model), "-o", str(Path(folder) / "mesh.stl"), "--tolerance", tolerance,
                   "--report", str(report), "--quiet", "--jobs", "1"]
        before = os.times()
        run = subprocess.run(command, capture_output=True, text=True, check=False, preexec_fn=limit_work)
        after = os.times()
        if run.returncode < 0:
            return f"ended by signal {-run.returncode}, the limit is {GIVE_UP} s"
        area = json.loads(report.read_text(encoding="utf-8"))["area"] if report.exists() else 0.0
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    if abs(area - right) > NEAR * right:
        silent = "" if run.returncode else "PROVEN "
        return f"{silent}an area of {area:.6g} for {right:.6g} ({area / right - 1 if right else area:+.2g})"
    if run.returncode:
        return (run.stderr.strip().splitlines() or [f"exit {run.returncode}"])[0].replace(str(model), "")
    return f"{seconds:.1f} s" if seconds > SECONDS else None


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--tolerance", action="append")
    parser.add_argument("--kind", action="append")
    options = parser.parse_args()
    rows = (options.folder / "INDEX.tsv").read_text(encoding="utf-8").splitlines()[1:]
    tried: Counter[str] = Counter()
    wrong: Counter[str] = Counter()
    for row in rows:
        name, _, right = row.split("\t")[:3]
        kind = re.sub(r"(_\d+)?\.\w+$", "", name)
        if options.kind and kind not in options.kind:
            continue
        for tolerance in options.tolerance or ["0.1%", "0.02%"]:
            tried[kind] += 1
            found = fault(options.program, options.folder / name, float(right), tolerance)
            if found:
                wrong[kind] += 1
                print(f"{name} at {tolerance}: {found}", flush=True)
    for kind, count in tried.items():
        print(f"{kind}: {wrong[kind]} of {count} wrong")
    print(f"{wrong.total()} of {tried.total()} wrong")
    return int(wrong.total() > 0)


if __name__ == "__main__":
    sys.exit(main())
