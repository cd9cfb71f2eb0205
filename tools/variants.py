#!/usr/bin/env python3
"""Rotated, mirrored and scaled variants of every corpus model keep all promises; so do 1, 2 and 8 threads.

    tools/variants.py [--binary PROGRAM] [--corpus corpus] [--only PATTERN] [--tolerance 0.1%] [--angle 20deg]
                      [--results out/tables/variants] [--keep FOLDER]

The tolerance is fixed in model terms: in mm as the original resolves it, times 1000 where the model is 1000
times larger. A variant must have the original's exit code and faces, watertight shells and a proven error
within the tolerance, and its number of triangles must lie within the larger of 1 % and 4. The mesh of the
original must be the same, byte for byte, on 1, 2 and 8 threads.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from arguments import ROOT, add_binary, parser_of

THREADS = (1, 2, 8)


@dataclass
class Run:
    exit: int | None
    report: dict | None
    mesh: bytes
    said: str


@dataclass
class Line:
    model: str
    triangles: dict[str, int | None]
    wrong: list[str]


class Binary:
    def __init__(self, path: Path, angle: str, folder: Path, timeout: float) -> None:
        self.path, self.angle, self.folder, self.timeout = path, angle, folder, timeout

    def run(self, model: Path, tolerance: str, threads: int = 1) -> Run:
        mesh, report = self.folder / "mesh.ply", self.folder / "mesh.json"
        for old in (mesh, report):
            old.unlink(missing_ok=True)
        command = [
            self.path,
            "mesh",
            model,
            "-o",
            mesh,
            "--tolerance",
            tolerance,
            "--angle",
            self.angle,
            "--jobs",
            str(threads),
            "--report",
            report,
            "--quiet",
        ]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, errors="replace", timeout=self.timeout
            )
        except subprocess.TimeoutExpired:
            return Run(None, None, b"", f"no result after {self.timeout:g} s")
        return Run(
            done.returncode,
            json.loads(report.read_text()) if report.exists() else None,
            mesh.read_bytes() if mesh.exists() else b"",
            done.stderr.strip(),
        )


def main() -> int:
    args = arguments()
    models = sorted(
        p for p in args.corpus.glob("*.step") if any(fnmatch.fnmatch(p.stem, o) for o in args.only)
    )
    with tempfile.TemporaryDirectory() as scratch:
        folder = args.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        binary = Binary(args.binary, args.angle, Path(scratch), args.timeout)
        lines = [line for model in models if (line := examine(binary, model, args.tolerance, folder))]
    args.results.parent.mkdir(parents=True, exist_ok=True)
    args.results.with_name(args.results.name + ".md").write_text(markdown(lines, args), encoding="utf-8")
    wrong = [line for line in lines if line.wrong]
    for line in wrong:
        print(f"{line.model}: {'; '.join(line.wrong)}")
    print(f"{len(lines)} models, {len(wrong)} with a variant that differs")
    return 1 if wrong else 0


def arguments() -> argparse.Namespace:
    parser = parser_of(__doc__)
    add_binary(parser)
    parser.add_argument("--corpus", type=Path, default=ROOT / "corpus")
    parser.add_argument("--only", nargs="+", default=["*"], help="shell patterns of model names")
    parser.add_argument("--tolerance", default="0.1%")
    parser.add_argument("--angle", default="20deg")
    parser.add_argument("--timeout", type=float, default=60)
    parser.add_argument("--results", type=Path, default=Path("out/tables/variants"))
    parser.add_argument("--keep", type=Path, help="leave the variants in this folder")
    return parser.parse_args()


def examine(binary: Binary, model: Path, tolerance: str, folder: Path) -> Line | None:
    """One model with all its variants; None where it has nothing to mesh."""
    first = binary.run(model, tolerance)
    if first.report is None:
        return (
            None
            if first.exit == 2
            else Line(model.stem, {}, [f"original: exit {first.exit}: {first.said[:100]}"])
        )
    absolute = first.report["options"]["tolerance"]
    line = Line(model.stem, {"original": first.report["triangles"]}, [])
    exact = f"{absolute!r}mm"
    meshes = [binary.run(model, exact, threads).mesh for threads in THREADS]
    if len(set(meshes)) != 1:
        line.wrong.append(f"threads {THREADS}: the bytes differ")
    text = model.read_bytes().decode("latin-1")
    from variants_text import VARIANTS

    for name, (change, scale) in VARIANTS.items():
        changed = change(text)
        if changed is None:
            continue
        path = folder / f"{model.stem}.{name}.step"
        path.write_bytes(changed.encode("latin-1"))
        run = binary.run(path, f"{absolute * scale!r}mm")
        line.triangles[name] = run.report["triangles"] if run.report else None
        line.wrong += [f"{name}: {wrong}" for wrong in differences(first, run)]
    return line


def differences(first: Run, run: Run) -> list[str]:
    """What a variant does not keep."""
    if run.report is None or run.exit != first.exit:
        return [f"exit {run.exit}, not {first.exit}: {run.said[:120]}"]
    a, b = first.report, run.report
    wrong = []
    if a["faces"]["total"] != b["faces"]["total"]:
        wrong.append(f"{b['faces']['total']} faces, not {a['faces']['total']}")
    if a["faces"]["failed"] != b["faces"]["failed"]:
        wrong.append(f"{b['faces']['failed']} failed faces, not {a['faces']['failed']}")
    if a["shells"] != b["shells"]:
        wrong.append(f"shells {b['shells']}, not {a['shells']}")
    if b["proven_error"] is not None and b["proven_error"] > b["options"]["tolerance"]:
        wrong.append("proven error over the tolerance")
    if abs(a["triangles"] - b["triangles"]) > max(0.01 * a["triangles"], 4):
        wrong.append(f"{b['triangles']} triangles, not {a['triangles']}")
    return wrong


def markdown(lines: list[Line], args: argparse.Namespace) -> str:
    from variants_text import VARIANTS

    names = ["original", *VARIANTS]
    kept = sum(not line.wrong for line in lines)
    text = [
        "# Variants of the corpus",
        "",
        f"Tolerance {args.tolerance} of the original's diagonal, fixed in model terms; angle {args.angle}. Triangles of each "
        "variant; – where it does not apply (`tools/variants_text.py` says why). Last: what it does not keep.",
        "",
        f"{len(lines)} models, {kept} keep everything.",
        "",
        "| model | " + " | ".join(names) + " | differs |",
        "|---" * (len(names) + 2) + "|",
    ]
    for line in lines:
        cells = [str(line.triangles[n]) if n in line.triangles else "–" for n in names]
        text.append(f"| {line.model} | " + " | ".join(cells) + f" | {'; '.join(line.wrong)} |")
    return "\n".join(text) + "\n"


if __name__ == "__main__":
    sys.exit(main())
