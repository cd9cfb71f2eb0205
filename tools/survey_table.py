#!/usr/bin/env python
"""The survey's comparison of tessellation strategies with measured numbers, and the 2001 paper's table of phases.

    tools/survey_table.py [--models ../shared/models] [--binary target/release/chordal] [--tolerance 0.1%]
                          [--results docs/results/survey.md]

Runs `chordal compare … --both-bounds --json` on some models of the corpus and, where the folder is there, on free-form
real ones; counts lines of code of each strategy's own parts. One command, one file.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

CORPUS = ["blade", "fillet_bspline", "torus_hole", "bracket", "spline_ball", "pipe_elbow"]
REAL = ["step/trj8_k1-db-214.stp", "step/ec_exhaust-A.stp", "step/fusee.stp", "iges/bearing.iges"]
STRATEGIES = ["grid", "cells", "coving", "delaunay-uniform", "delaunay-adaptive", "recursive", "quadtree", "bezier",
              "default"]
# The files that only this strategy needs, beside what all share.
OWN = {
    "grid": ["grid", "derivatives"],
    "cells": ["grid", "derivatives"],
    "coving": ["coving", "size", "grid", "derivatives"],
    "delaunay-uniform": ["delaunay", "size"],
    "delaunay-adaptive": ["delaunay"],
    "recursive": ["recursive", "derivatives"],
    "quadtree": ["quadtree", "node", "leaf_mesh", "tracking", "chords"],
    "bezier": ["bezier", "projected", "node", "scanlines", "loop_tree"],
    "default": ["../place", "../metric"],
}


def main() -> int:
    args = arguments()
    models = [Path("corpus") / f"{name}.step" for name in CORPUS]
    models += [args.models / name for name in REAL if (args.models / name).exists()]
    compared = {model.name: compare(model, args) for model in models}
    text = survey(compared, args) + phases(compared)
    args.results.write_text(text, encoding="utf-8")
    print(f"{len(models)} models -> {args.results}", file=sys.stderr)
    return 0


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=Path, default=Path("../shared/models"))
    parser.add_argument("--binary", type=Path, default=Path("target/release/chordal"))
    parser.add_argument("--tolerance", default="0.1%")
    parser.add_argument("--results", type=Path, default=Path("docs/results/survey.md"))
    return parser.parse_args()


def compare(model: Path, args: argparse.Namespace) -> dict:
    command = [args.binary, "compare", model, "--tolerance", args.tolerance, "--angle", "off", "--both-bounds", "--json", "-q",
               "--strategies", ",".join(STRATEGIES)]
    print(model.name, file=sys.stderr, flush=True)
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def lines_of_code(names: list[str]) -> int:
    """Lines that are neither empty, comment nor test."""
    count = 0
    for name in names:
        text = (Path("crates/tessellate/src/strategy") / f"{name}.rs").resolve().read_text(encoding="utf-8")
        text = text.split("#[cfg(test)]\nmod tests")[0]
        count += sum(1 for line in text.splitlines() if line.strip() and not line.strip().startswith("//"))
    return count


def rows_of(compared: dict[str, dict], strategy: str, bound: str) -> list[tuple[dict, float]]:
    return [(row, model["tolerance"]) for model in compared.values() for row in model["rows"]
            if (row["strategy"], row["bound"]) == (strategy, bound)]


def survey(compared: dict[str, dict], args: argparse.Namespace) -> str:
    out = [
        "# The survey's comparison, measured",
        "",
        "The survey of the Blender wiki compares uniform grid cut, Delaunay triangulation and recursive subdivision by plus and "
        f"minus signs. Here are numbers for its rows that can be measured (`tools/survey_table.py`, {len(compared)} models at "
        f"{args.tolerance}, angle off; seconds are CPU time of all threads). "
        "Ratios are geometric means over the models.",
        "",
        "- *Code*: lines of the strategy's own parts, beside those that all share (the survey's complexity 1 : 3 : 6).",
        "- *Triangles*: over the default's with the same bound (its *uses triangles efficiently*), and over the fewest possible.",
        "- *Error*: its *rigorous error bound*. Proven: the largest proven error of all models over the tolerance. Estimated: the "
        "largest measured one: what the method's own estimate is worth without a proof.",
        "- *Sewing*: failed faces; every mesh that the default closes is closed, since edges belong to no strategy.",
        "",
        "| strategy | code | triangles / default | triangles / fewest | estimated only: triangles / default | proven error / tolerance | "
        "estimated only: measured error / tolerance | seconds / default | failed faces |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    base = {bound: [row for row, _ in rows_of(compared, "default", bound)] for bound in ("proven", "estimated")}
    for strategy in STRATEGIES:
        proven, estimated = (rows_of(compared, strategy, bound) for bound in ("proven", "estimated"))
        share = {bound: mean([row["triangles"] / d["triangles"] for (row, _), d in zip(rows, base[bound])])
                 for bound, rows in (("proven", proven), ("estimated", estimated))}
        seconds = mean([max(row["seconds"], 1e-4) / max(d["seconds"], 1e-4) for (row, _), d in zip(proven, base["proven"])])
        errors = [row["proven_error"] / tolerance if row["proven_error"] is not None else float("inf")
                  for row, tolerance in proven]
        measured = max(row["measured_error"] / tolerance for row, tolerance in estimated)
        failed = sum(row["failed_faces"] for row, _ in proven + estimated)
        out.append(f"| `{strategy}` | {lines_of_code(OWN[strategy])} | {share['proven']:.2f} | "
                   f"{mean([row['ratio'] for row, _ in proven]):.2f} | {share['estimated']:.2f} | {largest(errors)} | "
                   f"{measured:.2f} | {seconds:.1f} | {failed} |")
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
        numbered = {m.group(1): s["count"] for s in row["stages"] if (m := re.search(r"\((\d)\)$", s["name"]))}
        cells = [f"{t:.1f}" for t in [*times, sum(times)]] + [str(numbered.get(k, 0)) for k in "1234"]
        out.append(f"| {name} | {model['faces']} | {' | '.join(cells)} |")
    out += ["", "Theirs, in seconds on a processor of 2001: 0.03, 0.27, 0.3 and 0.05 for 10 surfaces; 0.8, 211.8, 106.3 and 9.0 for "
            "4,419. Subdivision takes the largest share there; here cutting and triangulating does, which in theirs sets vertices wherever "
            "curves cross borders and needs no search for a way round them.", ""]
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
