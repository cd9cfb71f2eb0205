#!/usr/bin/env python3
"""Draws the plots of docs/results from the tables that the measuring tools write.

    tools/plot_results.py TABLES [-o docs/results]

TABLES is the folder with `models.tsv` (tools/measure_models.py), `speed.tsv` (tools/compare_occ.py) and
`methods.tsv` (crates/methods/tools/methods_on_models.py); a plot whose table is absent is not drawn. Writes
SVG files. Needs matplotlib.
"""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path

# Colours that stay apart for readers with colour blindness, on light and dark pages.
OURS, OTHER, PLAIN = "#0072b2", "#d55e00", "#888888"
# Errors over this many tolerances are drawn at the top edge, with their value.
TOP = 1.15


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tables", type=Path, help="folder with the tables")
    parser.add_argument(
        "-o", "--output", type=Path, default=Path(__file__).resolve().parent.parent / "docs" / "results"
    )
    args = parser.parse_args()
    args.output.mkdir(parents=True, exist_ok=True)
    drawn = 0
    for name, draw in (("speed", speed), ("models", accuracy), ("methods", methods)):
        table = args.tables / f"{name}.tsv"
        if not table.exists():
            print(f"{table} is absent: no plot of it", file=sys.stderr)
            continue
        with table.open(encoding="utf-8", newline="") as file:
            figure = draw(list(csv.DictReader(file, delimiter="\t")))
        # No date in the file: the same table gives the same bytes.
        figure.savefig(args.output / f"{name}.svg", metadata={"Date": None}, transparent=False)
        drawn += 1
    return 0 if drawn else 1


def new_figure(width: float = 8.0, height: float = 3.4):
    """A figure and its only axes, with fonts left to the reader's browser."""
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    matplotlib.rcParams.update(
        {
            "svg.fonttype": "none",
            "svg.hashsalt": "chordal",
            "font.family": "sans-serif",
            "font.size": 9,
            "axes.spines.top": False,
            "axes.spines.right": False,
        }
    )
    return plt.subplots(figsize=(width, height), layout="constrained")


def speed(rows: list[dict]):
    """How many times less CPU time than OpenCASCADE, file by file, and the triangles of both."""
    figure, axes = new_figure()
    ratios = sorted(float(row["ratio"]) for row in rows)
    triangles = sorted(float(row["occ_triangles"]) / float(row["our_triangles"]) for row in rows)
    files = range(1, len(rows) + 1)
    axes.semilogy(files, ratios, "o", color=OURS, markersize=4, label="CPU time, OpenCASCADE / Chordal")
    axes.semilogy(files, triangles, "s", color=OTHER, markersize=3, label="triangles, OpenCASCADE / Chordal")
    axes.axhline(1, color=PLAIN, linewidth=0.8)
    axes.set_xlabel(f"{len(rows)} STEP files, each series sorted")
    axes.set_ylabel("ratio (above 1: Chordal uses less)")
    axes.legend(frameon=False)
    return figure


def accuracy(rows: list[dict]):
    """Proven and measured error of every mesh, in units of its tolerance."""
    figure, axes = new_figure()
    good = [row for row in rows if row["exit"] == "0" and row["proven_error"] and row["s2m"] and row["m2s"]]
    by = sorted(good, key=lambda row: float(row["proven_error"]) / float(row["tolerance_mm"]))
    unit = [float(row["tolerance_mm"]) for row in by]
    proven = [float(row["proven_error"]) / u for row, u in zip(by, unit)]
    # What anyone can measure is bounded by the tolerance plus the file's own gap.
    measured = [max(float(row["s2m"]), float(row["m2s"])) / (u + allowance(row)) for row, u in zip(by, unit)]
    meshes = range(1, len(by) + 1)
    axes.plot(meshes, proven, "_", color=OURS, markersize=7, label="proven error / tolerance")
    axes.plot(
        meshes,
        measured,
        ".",
        color=OTHER,
        markersize=4,
        label="measured error / (tolerance + gap of the file)",
    )
    axes.axhline(1, color=PLAIN, linewidth=0.8)
    axes.set_ylim(0, TOP)
    over = [(mesh, error) for mesh, error in zip(meshes, measured) if error > TOP]
    axes.plot(
        [mesh for mesh, _ in over],
        [TOP] * len(over),
        "^",
        color=OTHER,
        markersize=6,
        clip_on=False,
        label="measured, beyond the scale" if over else None,
    )
    for mesh, error in over:
        axes.annotate(
            f"{error:.0f}", (mesh, TOP), (0, -12), textcoords="offset points", ha="center", color=OTHER
        )
    axes.set_xlabel(f"{len(by)} meshes with exit code 0, sorted by proven error")
    axes.set_ylabel("error / tolerance")
    axes.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.02), ncols=3)
    return figure


def allowance(row: dict) -> float:
    """How far the file's own edges lie off its surfaces, by our report or by the other kernel, in
    millimetres."""
    return max(float(row["gap"] or 0), float(row["occ_edge_gap"] or 0))


def methods(rows: list[dict]):
    """Triangles of every method, proven, over those of the default, summed over the models that all methods
    mesh."""
    figure, axes = new_figure(height=3.8)
    proven = [row for row in rows if row["bound"] == "proven" and row["triangles"]]
    names = sorted({row["strategy"] for row in proven})
    models = set.intersection(
        *({row["model"] for row in proven if row["strategy"] == name} for name in names)
    )
    total = {
        name: sum(
            int(row["triangles"]) for row in proven if row["strategy"] == name and row["model"] in models
        )
        for name in names
    }
    order = sorted(names, key=total.get, reverse=True)
    ratios = [total[name] / total["default"] for name in order]
    bars = axes.barh(order, ratios, color=[OURS if name == "default" else PLAIN for name in order])
    axes.bar_label(bars, [f"{ratio:.2f}" for ratio in ratios], padding=3)
    axes.set_xlabel(f"triangles over the default's, {len(models)} STEP files, all proven")
    axes.set_xlim(0, max(ratios) * 1.1)
    return figure


if __name__ == "__main__":
    sys.exit(main())
