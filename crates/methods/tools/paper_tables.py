#!/usr/bin/env python3
"""The tables of Balázs, Guthe, Klein 2004 on other models, as one page in Markdown.

    paper_tables.py MODELS [NAME ...] [--binary PROGRAM] [-o out/tables/paper_tables.md] [--tolerance 0.1%]

One thread, the shortest of three runs.
"""

import json
import pathlib
import subprocess
import sys

# The measuring tools of the repository are modules of these scripts.
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tools"))

from arguments import add_binary, add_models, parser_of  # noqa: E402

MODELS = [
    "fusee.stp",
    "trj8_k1-db-214.stp",
    "trj3_s1-al-214.stp",
    "ec_exhaust-A.stp",
    "freecad_SOD_323.stp",
    "bearing.iges",
]
# Table 2 of the document, Golf: conversion and approximation in seconds, edges; the 2D edges are those of
# Table 4.
THEIRS = {
    "bezier2d": (1.2, 77.3, 824_791),
    "bezier3d-point": (23.9, 4.4, 178_475),
    "bezier3d-line": (23.9, 4.4, 170_484),
    "bezier3d": (23.9, 5.9, 151_234),
    "bezier3d-worst-point": (23.9, 4.5, 181_280),
    "bezier3d-worst-line": (23.9, 4.6, 172_925),
    "bezier3d-worst": (23.9, 6.2, 153_680),
}


def measured(program, folder, names, tolerance):
    tables = []
    for name in names:
        found = sorted(pathlib.Path(folder).rglob(name))
        if not found:
            print(f"{name}: absent, left out")
            continue
        line = [program, "bench", "--papers", "--angle", "off", "--face-timeout", "4"]
        line += ["--tolerance", tolerance, str(found[0])]
        ran = subprocess.run(line, capture_output=True, text=True, check=True)
        tables += json.loads(ran.stdout)
        print(name)
    return tables


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(str(c) for c in row) + " |" for row in rows]


def ratio(a, b):
    return f"{a / b:.2f}" if b else "–"


def loops_of(model):
    return {row["method"]: row for row in model["loops"]}


def surfaces_of(model):
    return {(r["strategy"], r["edge_method"], r["bound"]): r for r in model["surfaces"]}


def edges_table(tables):
    out = ["## Trimming edges (Table 2)", ""]
    out += [
        "Every face by itself, whole loops simplified, as in the document. CPU seconds: conversion, approximation.",
        "",
    ]
    head = ["method"] + [m["model"] for m in tables] + ["document, Golf"]
    rows = []
    for method, (conversion, approximation, edges) in THEIRS.items():
        row = [f"`{method}`"]
        for m in tables:
            e = loops_of(m)[method]
            row.append(f"{e['edges']:,}<br>{e['conversion']:.3f} {e['approximation']:.3f}")
        rows.append(row + [f"{edges:,}<br>{conversion} {approximation}"])
    out += table(head, rows) + [""]
    head = ["ratio of edges"] + [m["model"] for m in tables] + ["document, Golf"]
    pairs = [
        ("2D over 3D point", "bezier2d", "bezier3d-point"),
        ("2D over 3D simplified", "bezier2d", "bezier3d"),
        ("point over line", "bezier3d-point", "bezier3d-line"),
        ("simplified over line", "bezier3d", "bezier3d-line"),
        ("worst over midpoint, line", "bezier3d-worst-line", "bezier3d-line"),
    ]
    rows = []
    for name, a, b in pairs:
        ours = [ratio(loops_of(m)[a]["edges"], loops_of(m)[b]["edges"]) for m in tables]
        rows.append([name] + ours + [ratio(THEIRS[a][2], THEIRS[b][2])])
    out += table(head, rows) + [""]
    crossed = ", ".join(f"{m['model']} {loops_of(m)['bezier3d']['crossings']}" for m in tables)
    left_out = ", ".join(f"{m['model']} {loops_of(m)['bezier3d']['left_out']}" for m in tables)
    out += [
        f"Vertices that the sweep set where loops met in the plane of parameters: {crossed}. Uses of edges without a curve"
    ]
    out += [f"in the plane of parameters: {left_out}.", ""]
    return out


def surfaces_table(tables):
    out = ["## Surfaces (Table 3)", ""]
    out += [
        "Triangles; CPU seconds for the whole mesh; milliseconds to evaluate all vertices, each by itself → with coherence.",
        "",
    ]
    keys = [k for k in surfaces_of(tables[0])]
    theirs = {
        ("quadtree", "bezier3d", "proven"): "1,511,056 183.6 → 175.2 s",
        ("quadtree", "bezier3d", "estimated"): "1,008,457 191.7 → 184.6 s",
        ("kd-worst", "bezier3d", "proven"): "796,438 100.1 → 96.9 s",
        ("kd-worst", "bezier3d", "estimated"): "464,354 101.3 → 97.3 s",
    }
    head = ["surface, edges, bound"] + [m["model"] for m in tables] + ["document, Golf"]
    rows = []
    for key in keys:
        row = [f"`{key[0]}`, `{key[1]}`, {key[2]}"]
        for m in tables:
            e = surfaces_of(m)[key]
            failed = f"<br>**{e['failed_faces']} faces failed**" if e["failed_faces"] else ""
            row.append(
                f"{e['triangles']:,} {e['seconds']:.2f} s<br>"
                f"{1e3 * e['evaluation']:.2f} → {1e3 * e['coherent']:.2f} ms{failed}"
            )
        rows.append(row + [theirs.get(key, "")])
    return out + table(head, rows) + [""]


def systems_table(tables):
    out = ["## The whole of it (Table 4)", ""]
    head = ["model", "method", "seconds", "triangles", "edges"]
    rows = []
    for m in tables:
        found = surfaces_of(m)
        for name, key in [
            ("quadtree, curves in the plane", ("quadtree", "bezier2d", "proven")),
            ("kd-tree, lifted curves, proven", ("kd-worst", "bezier3d", "proven")),
            ("kd-tree, lifted curves, estimated", ("kd-worst", "bezier3d", "estimated")),
            ("default", ("default", "default", "proven")),
        ]:
            e = found[key]
            rows.append([m["model"], name, f"{e['seconds']:.2f}", f"{e['triangles']:,}", f"{e['edges']:,}"])
    return out + table(head, rows) + [""]


def ratios_table(tables):
    out = ["## Ratios beside the document's", ""]
    head = ["ratio"] + [m["model"] for m in tables] + ["document"]
    lifted, plane, own = "bezier3d", "bezier2d", "default"

    def count(m, strategy, edges, bound, what="triangles"):
        return surfaces_of(m)[(strategy, edges, bound)][what]

    rows = []
    for name, a, b, theirs in [
        ("quadtree / kd, proven", ("quadtree", lifted, "proven"), ("kd-worst", lifted, "proven"), "1.9"),
        (
            "quadtree / kd, estimated",
            ("quadtree", lifted, "estimated"),
            ("kd-worst", lifted, "estimated"),
            "2.2",
        ),
        (
            "whole system, triangles",
            ("quadtree", plane, "proven"),
            ("kd-worst", lifted, "estimated"),
            "4.4 Golf, 19 console, 5.3 Beetle",
        ),
        ("kd proven / estimated", ("kd-worst", lifted, "proven"), ("kd-worst", lifted, "estimated"), "1.7"),
        (
            "quadtree proven / estimated",
            ("quadtree", lifted, "proven"),
            ("quadtree", lifted, "estimated"),
            "1.5",
        ),
        (
            "kd-midpoint / kd-worst, proven",
            ("kd-midpoint", lifted, "proven"),
            ("kd-worst", lifted, "proven"),
            "",
        ),
        ("kd-worst / default, proven", ("kd-worst", lifted, "proven"), ("default", own, "proven"), ""),
    ]:
        rows.append([name] + [ratio(count(m, *a), count(m, *b)) for m in tables] + [theirs])
    rows.append(
        ["edges in the mesh, 2D / 3D"]
        + [
            ratio(
                count(m, "quadtree", plane, "proven", "edges"),
                count(m, "kd-worst", lifted, "estimated", "edges"),
            )
            for m in tables
        ]
        + ["5.5 Golf, 16.5 console, 7.5 Beetle"]
    )
    rows.append(
        ["evaluation, each / coherent (kd-worst, proven)"]
        + [
            ratio(
                count(m, "kd-worst", lifted, "proven", "evaluation"),
                count(m, "kd-worst", lifted, "proven", "coherent"),
            )
            for m in tables
        ]
        + ["4 % of the whole time"]
    )
    return out + table(head, rows) + [""]


def main():
    parser = parser_of(__doc__)
    add_models(parser, "folder with the models, of any depth")
    parser.add_argument(
        "names", metavar="NAME", nargs="*", default=MODELS, help="files of MODELS [default: six public ones]"
    )
    add_binary(parser)
    parser.add_argument(
        "-o", "--output", type=pathlib.Path, default=pathlib.Path("out/tables/paper_tables.md")
    )
    parser.add_argument("--tolerance", default="0.1%")
    parser.add_argument("--json", help="keep the numbers here")
    args = parser.parse_args()
    tables = measured(args.binary, args.models, args.names, args.tolerance)
    if args.json:
        pathlib.Path(args.json).write_text(json.dumps(tables, indent=1))
    models = ", ".join(f"{m['model']} ({m['faces']} faces, {m['tolerance']:.4g} mm)" for m in tables)
    out = ["# The tables of Balázs, Guthe, Klein 2004 on our models", ""]
    out += [
        f"`paper_tables.py MODELS` at {args.tolerance}: {models}.",
        "One thread, shortest of three runs, without limit of angle, `--face-timeout 4`.",
        "",
    ]
    out += edges_table(tables) + surfaces_table(tables) + systems_table(tables) + ratios_table(tables)
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text("\n".join(out) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
