#!/usr/bin/env python3
"""Meshes every STEP file of a folder at each tolerance, measures the meshes independently, and writes one
table.

    tools/measure_models.py MODELS [--verify VERIFIER.py] [--only PATTERN] [--skip PATTERN] [--binary PROGRAM]
                            [--tolerances 0.1% 0.01%] [--angle 20deg] [--jobs 2] [--out out/models]
                            [--results out/tables/models] [--reuse]

Meshes (PLY) and reports (JSON) go to --out, the table to RESULTS.md and RESULTS.tsv. Without --verify nothing
is measured, and those columns stay empty. --reuse takes meshes and measurements that are in --out already.
The legend is in the table; tools/README.md explains how it is measured.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from arguments import add_binary, add_models, add_verifier, parser_of
from measure_row import Row, row_of
from measure_table import write_tables

HERE = Path(__file__).resolve().parent
SUFFIXES = {".step", ".stp"}


@dataclass(frozen=True)
class Settings:
    binary: Path
    verifier: Path | None
    out: Path
    tolerances: list[str]
    angle: str
    mesh_timeout: float
    verify_timeout: float
    threads: int
    reuse: bool
    extra: tuple[str, ...] = ()


@dataclass
class Meshing:
    """One run of the binary."""

    model: Path
    tolerance: str
    mesh: Path
    report: Path
    exit: int | None
    seconds: float
    message: str


def main() -> int:
    args = arguments()
    settings = Settings(
        args.binary,
        args.verify,
        args.out,
        args.tolerances,
        args.angle,
        args.timeout,
        args.verify_timeout,
        args.threads,
        args.reuse,
    )
    settings.out.mkdir(parents=True, exist_ok=True)
    expected = expected_faces(args.models)
    models = sorted(
        p
        for p in args.models.iterdir()
        if p.suffix.lower() in SUFFIXES
        and any(fnmatch.fnmatch(p.name, pattern) for pattern in args.only)
        and not any(fnmatch.fnmatch(p.name, pattern) for pattern in args.skip)
    )
    models.sort(key=lambda p: -p.stat().st_size)
    with ThreadPoolExecutor(args.jobs) as pool:
        rows = [
            row for found in pool.map(lambda m: measure_model(m, settings, expected), models) for row in found
        ]
    rows.sort(key=lambda r: (settings.tolerances.index(r.tolerance), r.model.lower()))
    write_tables(rows, args.results, describe(args, settings))
    failed = sum(bool(row.broken()) for row in rows)
    print(f"{len(rows)} rows, {failed} with a broken promise -> {args.results}.md", file=sys.stderr)
    return 1 if failed else 0


def arguments() -> argparse.Namespace:
    parser = parser_of(__doc__)
    add_models(parser)
    parser.add_argument("--only", nargs="+", default=["*"], help="shell patterns of file names")
    parser.add_argument("--skip", nargs="+", default=[], help="shell patterns of file names to leave out")
    add_binary(parser)
    add_verifier(parser)
    parser.add_argument("--tolerances", nargs="+", default=["0.1%", "0.01%"])
    parser.add_argument("--angle", default="20deg")
    parser.add_argument("--out", type=Path, default=Path("out/models"))
    parser.add_argument("--results", type=Path, default=Path("out/tables/models"))
    parser.add_argument("--jobs", type=int, default=2, help="models at the same time")
    parser.add_argument("--threads", type=int, default=1, help="threads of the binary")
    parser.add_argument("--timeout", type=float, default=300, help="seconds for meshing one file once")
    parser.add_argument("--verify-timeout", type=float, default=1800, help="seconds for measuring one file")
    parser.add_argument("--reuse", action="store_true", help="take what is in --out already")
    return parser.parse_args()


def describe(args: argparse.Namespace, settings: Settings) -> str:
    version = subprocess.run([args.binary, "--version"], capture_output=True, text=True).stdout.strip()
    return f"{version}; angle {settings.angle}; one thread, {args.jobs} models at a time, written as PLY"


def expected_faces(models: Path) -> dict[str, int]:
    """Faces of each file as the index of the models counts them, every instance."""
    for index, name, faces in (
        (models.parent / "INDEX.tsv", "name", "occ_faces"),
        (models / "INDEX.tsv", "name", "faces"),
    ):
        if index.exists():
            lines = index.read_text(encoding="utf-8").splitlines()
            head = lines[0].split("\t")
            rows = [dict(zip(head, line.split("\t"))) for line in lines[1:]]
            if faces in head:
                found = {row[name]: int(row[faces]) for row in rows if row.get(faces, "").isdigit()}
                return found | {f"{k}.step": v for k, v in found.items()}
    return {}


def measure_model(model: Path, settings: Settings, expected: dict[str, int]) -> list[Row]:
    runs = [mesh_model(model, tolerance, settings) for tolerance in settings.tolerances]
    measured = measure_meshes(model, runs, settings) if settings.verifier else {}
    rows = []
    for run in runs:
        report = json.loads(run.report.read_text()) if run.exit in (0, 1) and run.report.exists() else None
        rows.append(row_of(run, report, measured.get(str(run.mesh)), expected.get(model.name)))
    mark = "; ".join(f"{row.tolerance} {' '.join(row.broken()) or 'ok'}" for row in rows)
    print(f"{model.name}: {mark}", file=sys.stderr, flush=True)
    return rows


def mesh_model(model: Path, tolerance: str, settings: Settings) -> Meshing:
    """Runs the binary once; with --reuse a finished run is read back."""
    stem = f"{model.name}.{tolerance.replace('%', 'pc')}"
    mesh, report, log = (settings.out / f"{stem}{suffix}" for suffix in (".ply", ".json", ".run.json"))
    if settings.reuse and log.exists():
        return Meshing(model, tolerance, mesh, report, **json.loads(log.read_text()))
    for old in (mesh, report, log, settings.out / f"{model.name}.verify.json"):
        old.unlink(missing_ok=True)
    command = [
        settings.binary,
        "mesh",
        model,
        "-o",
        mesh,
        "--tolerance",
        tolerance,
        "--angle",
        settings.angle,
        "--jobs",
        str(settings.threads),
        "--report",
        report,
        "--quiet",
        *settings.extra,
    ]
    started = time.perf_counter()
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, errors="replace", timeout=settings.mesh_timeout
        )
        code, message = done.returncode, (done.stderr.strip().splitlines() or [""])[-1]
    except subprocess.TimeoutExpired:
        code, message = None, f"no result after {settings.mesh_timeout:g} s"
    outcome = {"exit": code, "seconds": time.perf_counter() - started, "message": message[:300]}
    log.write_text(json.dumps(outcome))
    return Meshing(model, tolerance, mesh, report, **outcome)


def measure_meshes(model: Path, runs: list[Meshing], settings: Settings) -> dict[str, dict]:
    """What the independent verifier says, by mesh; {"error": ...} where it did not finish."""
    kept = settings.out / f"{model.name}.verify.json"
    if settings.reuse and kept.exists():
        return json.loads(kept.read_text())
    done = [r for r in runs if r.exit in (0, 1) and r.mesh.exists() and r.report.exists()]
    if not done:
        return {}
    command = [
        sys.executable,
        HERE / "measure_one.py",
        settings.verifier,
        model,
        *(f"{r.mesh}={r.report}" for r in done),
    ]
    environment = os.environ | {"NUMBA_NUM_THREADS": "1", "NUMBA_CACHE_DIR": str(settings.out / ".numba")}
    try:
        result = subprocess.run(
            command,
            capture_output=True,
            text=True,
            errors="replace",
            env=environment,
            timeout=settings.verify_timeout,
        )
        lines = result.stdout.strip().splitlines()
        found = json.loads(lines[-1]) if result.returncode == 0 else None
        error = (result.stderr.strip().splitlines() or [f"ended with {result.returncode}"])[-1]
    except subprocess.TimeoutExpired:
        found, error = None, f"not measured within {settings.verify_timeout:g} s"
    answers = (
        {r["mesh"]: r for r in found} if found is not None else {str(r.mesh): {"error": error} for r in done}
    )
    kept.write_text(json.dumps(answers))
    return answers


if __name__ == "__main__":
    sys.exit(main())
