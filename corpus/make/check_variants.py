"""Meshes models whose right areas are known, and lists those that are not right.

    python corpus/make/check_variants.py target/release/chordal FOLDER [--tolerance 0.1%]...

FOLDER holds an INDEX.tsv with the columns file, tests and area, as `region.py` and `charts.py` write it.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

NEAR = 0.01
SECONDS = 60


def fault(program: str, model: Path, right: float, tolerance: str) -> str | None:
    """What is wrong with the mesh of a model, if anything."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [program, "mesh", str(model), "-o", str(Path(folder) / "mesh.stl"), "--tolerance", tolerance,
                   "--report", str(report), "--quiet"]
        try:
            run = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
        except subprocess.TimeoutExpired:
            return f"over {SECONDS} s"
        area = json.loads(report.read_text(encoding="utf-8"))["area"] if report.exists() else 0.0
    if abs(area - right) > NEAR * right:
        return f"an area of {area:.6g} for {right:.6g}"
    return run.stderr.strip().splitlines()[0] if run.returncode else None


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--tolerance", action="append")
    options = parser.parse_args()
    rows = (options.folder / "INDEX.tsv").read_text(encoding="utf-8").splitlines()[1:]
    tried = wrong = 0
    for row in rows:
        name, _, right = row.split("\t")[:3]
        for tolerance in options.tolerance or ["0.1%", "0.02%"]:
            tried += 1
            found = fault(options.program, options.folder / name, float(right), tolerance)
            if found:
                wrong += 1
                print(f"{name} at {tolerance}: {found}")
    print(f"{wrong} of {tried} wrong")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
