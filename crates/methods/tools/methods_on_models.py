#!/usr/bin/env python3
"""Meshes every STEP file of a folder by every method, proven and estimated, measures the meshes, writes one
table.

    methods_on_models.py MODELS [--verify VERIFIER.py] [--only PATTERN ...] [--skip PATTERN ...] [--largest KB]
                         [--strategies NAME ...] [--bounds proven estimated] [--tolerance 0.1%] [--jobs 2]
                         [--timeout 120] [--reuse] [--keep] [--measure proven estimated] [--most-triangles N]
                         [--out out/methods] [--results out/tables/methods]

One run of the program per model, method and bound. The verifier's reference of a model is built once for all
of its meshes. A run that does not end in --timeout seconds is a line that says so. Small files come first.
Meshes are removed as soon as they are measured, unless --keep leaves them for a later run with --reuse, which
takes what is in --out: mesh all files first, then measure as many as there is time for. A measurement is kept
with the hash of its mesh and taken again for a mesh of the same bytes.
"""

from __future__ import annotations

import argparse
import fnmatch
import hashlib
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

# The measuring tools of the repository are modules of these scripts.
sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tools"))

from arguments import ROOT, add_binary, add_models, add_verifier, parser_of  # noqa: E402
from measure_models import SUFFIXES, Meshing, Settings, expected_faces, measure_meshes, mesh_model
from measure_row import row_of

# The share of splines among the faces of a free-form model.
SPLINES = 0.1


@dataclass
class Line:
    """One model by one strategy with one bound."""

    model: str
    strategy: str
    bound: str
    exit: int | None
    seconds: float
    triangles: int | None = None
    ratio: float | None = None
    tolerance: float | None = None
    proven: float | None = None
    gap: float | None = None
    measured: float | None = None
    closed: bool | None = None
    failed: int | None = None
    kind: str = ""
    faults: tuple[str, ...] = ()


def main() -> int:
    args = arguments()
    args.out.mkdir(parents=True, exist_ok=True)
    args.results.parent.mkdir(parents=True, exist_ok=True)
    names = args.strategies or strategies(args.binary)
    if "default" not in names:
        names.insert(0, "default")
    models = [p for p in args.models.iterdir() if p.suffix.lower() in SUFFIXES and wanted(p, args)]
    models.sort(key=lambda p: p.stat().st_size)
    expected = expected_faces(args.models)
    with ThreadPoolExecutor(args.jobs) as pool:
        found = list(pool.map(lambda m: measure(m, names, args, expected), models))
    lines = [line for of_model in found for line in of_model]
    text = table(lines, names, args)
    args.results.with_suffix(".md").write_text(text, encoding="utf-8")
    args.results.with_suffix(".tsv").write_text(tsv(lines), encoding="utf-8")
    faults = sum(bool(line.faults) for line in lines)
    print(
        f"{len(lines)} meshes of {len(models)} models, {faults} with a fault -> {args.results}.md",
        file=sys.stderr,
    )
    return 1 if faults else 0


def arguments() -> argparse.Namespace:
    parser = parser_of(__doc__)
    add_models(parser)
    parser.add_argument("--only", nargs="+", default=["*"], help="shell patterns of file names")
    parser.add_argument("--skip", nargs="+", default=[], help="shell patterns of file names to leave out")
    parser.add_argument(
        "--largest", type=float, default=float("inf"), help="leave out files larger than this (KB)"
    )
    add_binary(parser)
    add_verifier(parser)
    parser.add_argument("--strategies", nargs="+", default=[], help="names [default: all]")
    parser.add_argument(
        "--bounds", nargs="+", default=["proven", "estimated"], choices=["proven", "estimated"]
    )
    parser.add_argument("--tolerance", default="0.1%")
    parser.add_argument("--out", type=Path, default=Path("out/methods"))
    parser.add_argument("--results", type=Path, default=Path("out/tables/methods"))
    parser.add_argument("--jobs", type=int, default=2, help="models at the same time")
    parser.add_argument("--timeout", type=float, default=120, help="seconds for meshing one file once")
    parser.add_argument("--verify-timeout", type=float, default=1800, help="seconds for measuring one file")
    parser.add_argument("--reuse", action="store_true", help="take what lies in --out already")
    parser.add_argument("--keep", action="store_true", help="leave the meshes in --out, to be measured later")
    parser.add_argument(
        "--measure", nargs="+", default=["proven", "estimated"], help="bounds whose meshes are measured"
    )
    parser.add_argument("--most-triangles", type=int, default=10**9, help="larger meshes are not measured")
    return parser.parse_args()


def wanted(model: Path, args: argparse.Namespace) -> bool:
    named = any(fnmatch.fnmatch(model.name, p) for p in args.only) and not any(
        fnmatch.fnmatch(model.name, p) for p in args.skip
    )
    return named and model.stat().st_size <= 1024 * args.largest


def strategies(binary: Path) -> list[str]:
    """The names that the binary knows, the default first."""
    model = ROOT / "corpus" / "ap203.step"
    done = subprocess.run(
        [binary, "compare", model, "--tolerance", "5%", "--json", "-q"],
        capture_output=True,
        text=True,
        check=True,
    )
    return [row["strategy"] for row in json.loads(done.stdout)["rows"]]


def measure(model: Path, names: list[str], args: argparse.Namespace, expected: dict[str, int]) -> list[Line]:
    """All meshes of one model."""
    runs: list[tuple[str, str, Meshing]] = []
    for name in names:
        for bound in args.bounds:
            settings = settings_for(args, args.out / model.name / f"{name}.{bound}", name, bound)
            runs.append((name, bound, mesh_model(model, args.tolerance, settings)))
    measured = known_measurements(model, [run for _, bound, run in runs if bound in args.measure], args)
    for _, _, run in runs:
        if not args.keep:
            run.mesh.unlink(missing_ok=True)
    lines = [
        line_of(name, bound, run, measured.get(str(run.mesh)), expected.get(model.name))
        for name, bound, run in runs
    ]
    kind = next(
        (kind_of(run.report) for name, _, run in runs if name == "default" and run.report.exists()), ""
    )
    for line in lines:
        line.kind = kind
    judge(lines)
    bad = [f"{line.strategy} {line.bound}: {', '.join(line.faults)}" for line in lines if line.faults]
    print(f"{model.name}: {'; '.join(bad) or 'ok'}", file=sys.stderr, flush=True)
    return lines


def kind_of(report: Path) -> str:
    """The class of a model by its faces: a single one; a tenth or more of them splines; or neither."""
    faces = json.loads(report.read_text())["faces_detail"]
    splines = sum(face["instances"] for face in faces if face["kind"] == "nurbs")
    whole = sum(face["instances"] for face in faces)
    if whole == 1:
        return "single face"
    return "free-form" if splines >= SPLINES * whole else "mechanical"


def known_measurements(model: Path, runs: list[Meshing], args: argparse.Namespace) -> dict[str, dict]:
    """What the verifier says about each mesh, asked again only for meshes that it has not seen."""
    kept = args.out / model.name / "measured.json"
    known = json.loads(kept.read_text()) if kept.exists() else {}
    hashes = {
        str(run.mesh): hashlib.sha256(run.mesh.read_bytes()).hexdigest() for run in runs if run.mesh.exists()
    }
    new = [run for run in runs if hashes.get(str(run.mesh)) not in (None, *known) and small(run, args)]
    if new and args.verify:
        settings = settings_for(args, args.out / model.name, "", "")
        found = measure_meshes(model, new, replace(settings, reuse=False))
        known |= {hashes[mesh]: result for mesh, result in found.items() if "error" not in result}
        kept.write_text(json.dumps(known))
    return {mesh: known[of_mesh] for mesh, of_mesh in hashes.items() if of_mesh in known}


def small(run: Meshing, args: argparse.Namespace) -> bool:
    """Whether the mesh is to be measured at all."""
    if run.exit not in (0, 1) or not run.report.exists():
        return False
    return json.loads(run.report.read_text())["triangles"] <= args.most_triangles


def settings_for(args: argparse.Namespace, out: Path, strategy: str, bound: str) -> Settings:
    out.mkdir(parents=True, exist_ok=True)
    extra = ["--strategy", strategy, "--bound", bound] if strategy else []
    return Settings(
        args.binary,
        args.verify,
        out,
        [args.tolerance],
        "off",
        args.timeout,
        args.verify_timeout,
        1,
        args.reuse,
        tuple(extra),
    )


def line_of(name: str, bound: str, run: Meshing, measured: dict | None, faces: int | None) -> Line:
    line = Line(run.model.name, name, bound, run.exit, run.seconds)
    if run.exit not in (0, 1) or not run.report.exists():
        return line
    report = json.loads(run.report.read_text())
    row = row_of(run, report, measured, faces)
    line.triangles, line.ratio = report["triangles"], report["triangles"] / max(report["lower_bound"], 1)
    line.tolerance, line.proven, line.gap = report["options"]["tolerance"], report["proven_error"], max(row.gap or 0.0, row.occ_edge_gap or 0.0)
    line.closed = report["closedness"] == "closed"
    line.failed = report["faces"]["failed"]
    line.measured = row.measured
    return line


def judge(lines: list[Line]) -> None:
    """What the document promises: no crash, closed where the default is, proven ones within tolerance."""
    default = {line.bound: line for line in lines if line.strategy == "default"}
    for line in lines:
        reference = default.get("proven", default.get(line.bound))
        faults = []
        if line.exit not in (0, 1):
            faults.append("no mesh" if line.exit is not None else "out of time")
        elif reference is not None and reference.triangles is not None:
            if reference.closed and not line.closed:
                faults.append("open")
            if (line.failed or 0) > (reference.failed or 0):
                faults.append("faces failed")
            kept = reference.proven is not None and reference.proven <= reference.tolerance
            if (
                line.bound == "proven"
                and kept
                and not (line.proven is not None and line.proven <= line.tolerance)
            ):
                faults.append("not proven")
            if (
                line.bound == "proven"
                and line.measured is not None
                and line.measured > line.tolerance + line.gap
            ):
                within = (
                    reference.measured is not None
                    and reference.measured <= reference.tolerance + reference.gap
                )
                faults.append("out of tolerance" if within else "out of tolerance, as the default")
        line.faults = tuple(faults)


def table(lines: list[Line], names: list[str], args: argparse.Namespace) -> str:
    models = {line.model for line in lines}
    limit = f" with at most {args.most_triangles:,} triangles" if args.most_triangles < 10**9 else ""
    out = [
        "# Every strategy on real models",
        "",
        f"`methods_on_models.py`: {len(models)} STEP files at {args.tolerance}, angle off, one thread, "
        f"{args.timeout:g} s for each mesh.",
        "*Closed* counts the models that the default closes and the strategy does, too; *within* those whose measured "
        f"error is at most tolerance + gap, of those that were measured{limit} (by the evaluators of another kernel). Ratios are of the triangles to the fewest possible, over all models, their median.",
        "",
        "| strategy | bound | meshes | closed | proven | within | failed faces | triangles | median ratio | seconds |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    everywhere = complete(lines)
    for name in names:
        for bound in args.bounds:
            out.append(
                summary([line for line in lines if (line.strategy, line.bound) == (name, bound)], everywhere)
            )
    out += [
        "",
        f"Triangles and seconds are sums over the {len(everywhere)} models that every strategy meshed in time.",
        "",
    ]
    bad = [line for line in lines if line.faults]
    out += ["## Faults", ""] + (
        ["None."]
        if not bad
        else [
            "| model | strategy | bound | what | proven / tolerance | measured / (tolerance + gap) |",
            "|---|---|---|---|---|---|",
        ]
    )
    for line in bad:
        share = f"{line.proven / line.tolerance:.3f}" if line.proven is not None and line.tolerance else ""
        far = f"{line.measured / (line.tolerance + line.gap):.3f}" if line.measured is not None else ""
        out.append(
            f"| {line.model} | {line.strategy} | {line.bound} | {', '.join(line.faults)} | {share} | {far} |"
        )
    return "\n".join([*out, *classes(lines, names), *fewer(lines)]) + "\n"


def classes(lines: list[Line], names: list[str]) -> list[str]:
    """Triangles by class of model, over the models that every strategy proves."""
    proven = [
        line
        for line in lines
        if line.bound == "proven" and line.proven is not None and line.proven <= line.tolerance
    ]
    by = {(line.model, line.strategy): line for line in proven}
    models = sorted({line.model for line in proven if all((line.model, name) in by for name in names)})
    kind = {model: by[model, names[0]].kind for model in models}
    kinds = [k for k in ("mechanical", "free-form", "single face") if k in kind.values()]
    head = " | ".join(f"{k} ({sum(v == k for v in kind.values())})" for k in kinds)
    out = [
        "",
        "## Triangles by class, all proven",
        "",
        f"Sums over the {len(models)} models that every strategy proves. *Free-form*: at least {SPLINES:.0%} of the faces are splines; *single face*: one face; "
        "*mechanical*: all others.",
        "",
        f"| strategy | {head} |",
        "|---|" + "---|" * len(kinds),
    ]
    sums = {
        name: [sum(by[m, name].triangles for m in models if kind[m] == k) for k in kinds] for name in names
    }
    least = [min(column) for column in zip(*sums.values())]
    for name in names:
        cells = [f"**{n:,}**" if n == low else f"{n:,}" for n, low in zip(sums[name], least)]
        out.append(f"| {name} | " + " | ".join(cells) + " |")
    return out


def fewer(lines: list[Line]) -> list[str]:
    """Where another strategy needs fewer triangles than the default, both with a proof."""
    kept = [
        line
        for line in lines
        if line.bound == "proven" and line.proven is not None and line.proven <= line.tolerance
    ]
    default = {line.model: line for line in kept if line.strategy == "default"}
    found = [
        line for line in kept if line.model in default and line.triangles < default[line.model].triangles
    ]
    out = [
        "",
        "## Fewer triangles than the default, both proven",
        "",
        f"On {len(default) - len({line.model for line in found})} of the {len(default)} models that the default proves no strategy has fewer.",
        "",
    ]
    if found:
        out += ["| model | strategy | triangles | default |", "|---|---|---|---|"]
    out += [
        f"| {line.model} | {line.strategy} | {line.triangles} | {default[line.model].triangles} |"
        for line in found
    ]
    return out


def complete(lines: list[Line]) -> set[str]:
    """Models that every strategy meshed."""
    return {line.model for line in lines} - {line.model for line in lines if line.triangles is None}


def summary(own: list[Line], everywhere: set[str]) -> str:
    done = [line for line in own if line.triangles is not None]
    ratios = sorted(line.ratio for line in done if line.ratio is not None) or [float("nan")]
    closed = sum(1 for line in done if "open" not in line.faults)
    proven = sum(1 for line in done if line.proven is not None and line.proven <= line.tolerance)
    within = [line for line in done if line.measured is not None]
    kept = sum(1 for line in within if line.measured <= line.tolerance + line.gap)
    common = [line for line in done if line.model in everywhere]
    return (
        f"| {own[0].strategy} | {own[0].bound} | {len(done)} of {len(own)} | {closed} | {proven} | {kept} of {len(within)} | "
        f"{sum(line.failed or 0 for line in done)} | {sum(line.triangles for line in common):,} | "
        f"{ratios[len(ratios) // 2]:.2f} | {sum(line.seconds for line in common):.1f} |"
    )


def tsv(lines: list[Line]) -> str:
    columns = [
        "model",
        "strategy",
        "bound",
        "exit",
        "seconds",
        "triangles",
        "ratio",
        "tolerance",
        "proven",
        "gap",
        "measured",
        "closed",
        "failed",
        "kind",
        "faults",
    ]

    def cell(value: object) -> str:
        if value is None:
            return ""
        if isinstance(value, tuple):
            return ", ".join(value)
        return f"{value:.6g}" if isinstance(value, float) else str(value)

    rows = ["\t".join(cell(getattr(line, column)) for column in columns) for line in lines]
    return "\n".join(["\t".join(columns), *rows]) + "\n"


if __name__ == "__main__":
    sys.exit(main())
