#!/usr/bin/env python3
"""The survey's comparison of tessellation strategies with measured numbers, and the 2001 paper's table of
phases.

    survey_table.py [MODELS] [--binary PROGRAM] [--tolerance 0.1%] [--results out/tables/survey.md]

Runs `chordal compare … --both-bounds --json` on six models of the corpus and on those of four public ones
that MODELS holds.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

# The measuring tools of the repository are modules of these scripts.
sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tools"))

from arguments import ROOT, add_binary, parser_of  # noqa: E402

CORPUS = ["blade", "fillet_bspline", "torus_hole", "bracket", "spline_ball", "pipe_elbow"]
REAL = ["trj8_k1-db-214.stp", "ec_exhaust-A.stp", "fusee.stp", "bearing.iges"]
STRATEGIES = [
    "grid",
    "cells",
    "coving",
    "delaunay-uniform",
    "delaunay-adaptive",
    "recursive",
    "quadtree",
    "bezier",
    "default",
]


def main() -> int:
    args = arguments()
    models = [ROOT / "corpus" / f"{name}.step" for name in CORPUS]
    models += [path for name in REAL if args.models and (path := next(args.models.rglob(name), None))]
    compared = {model.name: compare(model, args) for model in models}
    text = survey(compared, args) + phases(compared)
    args.results.parent.mkdir(parents=True, exist_ok=True)
    args.results.write_text(text, encoding="utf-8")
    print(f"{len(models)} models -> {args.results}", file=sys.stderr)
    return 0


def arguments() -> argparse.Namespace:
    parser = parser_of(__doc__)
    parser.add_argument(
        "models",
        type=Path,
        nargs="?",
        help="folder with free-form models, of any depth [default: the corpus alone]",
    )
    add_binary(parser)
    parser.add_argument("--tolerance", default="0.1%")
    parser.add_argument("--results", type=Path, default=Path("out/tables/survey.md"))
    return parser.parse_args()


def compare(model: Path, args: argparse.Namespace) -> dict:
    command = [
        args.binary,
        "compare",
        model,
        "--tolerance",
        args.tolerance,
        "--angle",
        "off",
        "--both-bounds",
        "--json",
        "-q",
        "--strategies",
        ",".join(STRATEGIES),
    ]
    print(model.name, file=sys.stderr, flush=True)
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def rows_of(compared: dict[str, dict], strategy: str, bound: str) -> list[tuple[dict, float]]:
    return [
        (row, model["tolerance"])
        for model in compared.values()
        for row in model["rows"]
        if (row["strategy"], row["bound"]) == (strategy, bound)
    ]


def survey(compared: dict[str, dict], args: argparse.Namespace) -> str:
    out = [
        "# The survey's comparison, measured",
        "",
        "The survey of the Blender wiki compares uniform grid cut, Delaunay triangulation and recursive subdivision by plus and "
        f"minus signs. Here are numbers for its rows that can be measured (`survey_table.py`, {len(compared)} models at "
        f"{args.tolerance}, angle off; seconds are CPU time of all threads). "
        "Ratios are geometric means over the models.",
        "",
        "- *Triangles*: over the default's with the same bound (its *uses triangles efficiently*), and over the fewest possible.",
        "- *Error*: its *rigorous error bound*. Proven: the largest proven error of all models over the tolerance. Estimated: the "
        "largest measured one: what the method's own estimate is worth without a proof.",
        "- *Sewing*: failed faces; every mesh that the default closes is closed, since edges belong to no strategy.",
        "",
        "| strategy | triangles / default | triangles / fewest | estimated only: triangles / default | proven error / tolerance | "
        "estimated only: measured error / tolerance | seconds / default | failed faces |",
        "|---|---|---|---|---|---|---|---|",
    ]
    base = {
        bound: [row for row, _ in rows_of(compared, "default", bound)] for bound in ("proven", "estimated")
    }
    for strategy in STRATEGIES:
        proven, estimated = (rows_of(compared, strategy, bound) for bound in ("proven", "estimated"))
        share = {
            bound: mean([row["triangles"] / d["triangles"] for (row, _), d in zip(rows, base[bound])])
            for bound, rows in (("proven", proven), ("estimated", estimated))
        }
        seconds = mean(
            [
                max(row["seconds"], 1e-4) / max(d["seconds"], 1e-4)
                for (row, _), d in zip(proven, base["proven"])
            ]
        )
        errors = [
            row["proven_error"] / tolerance if row["proven_error"] is not None else float("inf")
            for row, tolerance in proven
        ]
        measured = max(row["measured_error"] / tolerance for row, tolerance in estimated)
        failed = sum(row["failed_faces"] for row, _ in proven + estimated)
        out.append(
            f"| `{strategy}` | {share['proven']:.2f} | "
            f"{mean([row['ratio'] for row, _ in proven]):.2f} | {share['estimated']:.2f} | {largest(errors)} | "
            f"{measured:.2f} | {seconds:.1f} | {failed} |"
        )
    return "\n".join(out) + "\n\n"


def phases(compared: dict[str, dict]) -> str:
    """The rows of the table of Kahlesz, Balázs, Klein 2001."""
    out = [
        "## Phases of the quadtree",
        "",
        "The rows of the table of Kahlesz, Balázs, Klein 2001, in milliseconds on these models (the last attempt at each face, "
        "without the proof), and how often each transition of their state machine was taken.",
        "",
        "| model | faces | conversion | quadtree | traversal | trimming, triangulation | sum | reach a border (1) | leave a vertex (2) | "
        "end inside (3) | along a border (4) |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for name, model in compared.items():
        row = next(r for r in model["rows"] if (r["strategy"], r["bound"]) == ("quadtree", "proven"))
        times = [1000 * row["phases"][p] for p in ("conversion", "subdivision", "traversal", "triangulation")]
        numbered = {
            m.group(1): s["count"] for s in row["stages"] if (m := re.search(r"\((\d)\)$", s["name"]))
        }
        cells = [f"{t:.1f}" for t in [*times, sum(times)]] + [str(numbered.get(k, 0)) for k in "1234"]
        out.append(f"| {name} | {model['faces']} | {' | '.join(cells)} |")
    out += [
        "",
        "Theirs, in seconds on a processor of 2001: 0.03, 0.27, 0.3 and 0.05 for 10 surfaces; 0.8, 211.8, 106.3 and 9.0 for "
        "4,419. Subdivision takes the largest share there; here cutting and triangulating does, which in theirs sets vertices wherever "
        "curves cross borders and needs no search for a way round them.",
        "",
    ]
    return "\n".join(out)


def largest(errors: list[float]) -> str:
    unproven = sum(e == float("inf") for e in errors)
    return f"not proven on {unproven} of {len(errors)}" if unproven else f"{max(errors):.3f}"


def mean(values: list[float]) -> float:
    product = 1.0
    for value in values:
        product *= value ** (1 / len(values))
    return product


if __name__ == "__main__":
    sys.exit(main())
