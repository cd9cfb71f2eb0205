#!/usr/bin/env python
"""Strategies side by side on models of every class: docs/results/strategies.md.

    tools/strategies_table.py CHORDAL MODELS [--tolerance 0.1%] [-o docs/results/strategies.md]

CHORDAL is a release build of the program, MODELS the folder of real models (files are found below it at any depth). The head of
the document is written here, its remarks are kept: everything from the line "## Beside the figures" on stays as it is.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

CLASSES = {
    "mechanical": ["as1-oc-214-mat.stp", "screw.step", "bearing.iges"],
    "free-form": ["trj8_k1-db-214.stp", "ec_exhaust-A.stp", "fusee.stp"],
    "single face": ["corpus/spline_ball.step", "corpus/torus_full.step", "corpus/sphere_side_cut.step"],
}
STRATEGIES = ["default", "kd-midpoint", "kd-worst", "binary-midpoint", "binary-worst", "grid", "cells", "recursive", "quadtree",
              "quadtree-eq3", "bezier", "coving", "delaunay-uniform", "delaunay-adaptive"]
REMARKS = "## Beside the figures"


def main() -> int:
    args = arguments()
    tables, fewest, compared, kinds = [], [], {}, {}
    for kind, names in CLASSES.items():
        for name in names:
            path = Path(name) if name.startswith("corpus/") else next(args.models.rglob(name), None)
            if path is None:
                print(f"{name}: not there, left out", file=sys.stderr)
                continue
            print(path.name, file=sys.stderr, flush=True)
            compared[path.name] = result = compare(path, args)
            kinds.setdefault(kind, []).append(result)
            tables += table(path.name, kind, result)
            fewest.append(best(path.name, kind, result))
    old = args.output.read_text(encoding="utf-8") if args.output.exists() else ""
    remarks = old[old.index(REMARKS):].splitlines() if REMARKS in old else []
    text = [*head(args), *by_class(kinds), *summary(fewest), *ratios(compared), *tables, *remarks]
    args.output.write_text("\n".join(text).rstrip() + "\n", encoding="utf-8")
    return 0


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary", type=Path)
    parser.add_argument("models", type=Path)
    parser.add_argument("--tolerance", default="0.1%")
    parser.add_argument("-o", "--output", type=Path, default=Path("docs/results/strategies.md"))
    return parser.parse_args()


def compare(path: Path, args: argparse.Namespace) -> dict:
    command = [args.binary, "compare", path, "--tolerance", args.tolerance, "--angle", "off", "--both-bounds", "--json", "-q",
               "--strategies", ",".join(STRATEGIES)]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def head(args: argparse.Namespace) -> list[str]:
    return [
        "# Strategies on models of every class",
        "",
        f"`tools/strategies_table.py` runs `chordal compare MODEL --both-bounds --angle off` at {args.tolerance}, on a machine with two "
        "cores that had other work to do; seconds are CPU time of all threads. *Measured* is the largest distance of samples of the "
        "exact surfaces from the mesh. *Edges* are chords of the model's edges, *ratio* is triangles over the fewest possible "
        "([report.md](../report.md)). The documents' methods see surfaces of all kinds as NURBS.",
        "",
    ]


def proven(result: dict) -> list[dict]:
    """Rows that keep the tolerance by proof."""
    kept = (row for row in result["rows"] if row["bound"] == "proven" and row["proven_error"] is not None)
    return [row for row in kept if row["proven_error"] <= result["tolerance"]]


def best(name: str, kind: str, result: dict) -> tuple:
    rows = sorted(proven(result), key=lambda row: row["triangles"])
    default = next((row for row in rows if row["strategy"] == "default"), None)
    others = [row for row in rows if row["strategy"] != "default"]
    return name, kind, default, others[0] if others else None


def by_class(kinds: dict[str, list[dict]]) -> list[str]:
    """Sums of proven triangles; a strategy that does not prove a model has none in its class."""
    out = ["## Triangles by class, all proven", "", f"| strategy | {' | '.join(kinds)} |", "|---|" + "---|" * len(kinds)]
    sums = {}
    for name in STRATEGIES:
        rows = [[next((r["triangles"] for r in proven(result) if r["strategy"] == name), None) for result in results]
                for results in kinds.values()]
        sums[name] = [None if None in row else sum(row) for row in rows]
    least = [min(n for n in column if n is not None) for column in zip(*sums.values())]
    for name, row in sums.items():
        cells = ["not proven" if n is None else f"**{n:,}**" if n == low else f"{n:,}" for n, low in zip(row, least)]
        out.append(f"| {name} | {' | '.join(cells)} |")
    return [*out, ""]


def summary(fewest: list[tuple]) -> list[str]:
    out = ["## The fewest triangles with a proof", "", "| class | model | default | the next best | over the default |", "|---|---|---|---|---|"]
    for name, kind, default, other in fewest:
        if default is None or other is None:
            out.append(f"| {kind} | {name} | not proven | | |")
            continue
        share = other["triangles"] / default["triangles"]
        out.append(f"| {kind} | {name} | {default['triangles']} | {other['triangles']} `{other['strategy']}` | {share:.2f} |")
    return [*out, ""]


def ratios(compared: dict[str, dict]) -> list[str]:
    """The ratios that Balázs, Guthe, Klein 2004 report."""
    out = ["## Ratios", "", "| model | quadtree over kd-midpoint, proven | kd-midpoint, proven over estimated | edges, quadtree over "
           "kd-midpoint | kd-worst over kd-midpoint |", "|---|---|---|---|---|"]
    for name, result in compared.items():
        row = {(r["strategy"], r["bound"]): r for r in result["rows"]}
        kd, estimated, quadtree, worst = (row[key] for key in (
            ("kd-midpoint", "proven"), ("kd-midpoint", "estimated"), ("quadtree", "proven"), ("kd-worst", "proven")))
        out.append(f"| {name} | {quadtree['triangles'] / kd['triangles']:.1f} | {kd['triangles'] / estimated['triangles']:.2f} | "
                   f"{quadtree['edges'] / kd['edges']:.2f} | {worst['triangles'] / kd['triangles']:.2f} |")
    return [*out, ""]


def table(name: str, kind: str, result: dict) -> list[str]:
    out = [f"## {name}", "", f"{kind.capitalize()}, {result['faces']} faces, tolerance {result['tolerance']:.6f} mm.", "",
           "| strategy | bound | triangles | edges | seconds | proven mm | measured mm | ratio | failed faces |",
           "|---|---|---|---|---|---|---|---|---|"]
    for row in result["rows"]:
        error = f"{row['proven_error']:.4e}" if row["proven_error"] is not None else "none"
        out.append(f"| {row['strategy']} | {row['bound']} | {row['triangles']} | {row['edges']} | {row['seconds']:.2f} | {error} | "
                   f"{row['measured_error']:.4e} | {row['ratio']:.2f} | {row['failed_faces']} |")
    return [*out, ""]


if __name__ == "__main__":
    sys.exit(main())
