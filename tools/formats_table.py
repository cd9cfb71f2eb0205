#!/usr/bin/env python3
"""Meshes every file of a folder of other formats than STEP, as a user gets them, and prints a table in
Markdown.

    tools/formats_table.py MODELS [--binary PROGRAM] [--out TABLE.md]

MODELS has one folder per format: iges, brep, iv, x3d, obj, json, 3dm. Each file is meshed with the defaults
and `--sew auto` at 0.1 % of its diagonal. The figures are those of the reports. MODELS/INDEX.tsv, if there is
one, gives the number of faces that another kernel finds (columns kind, name, occ_faces).
"""

import csv
import json
import subprocess
import tempfile
from pathlib import Path

from arguments import add_binary, add_models, parser_of

FOLDERS = ["iges", "brep", "iv", "x3d", "obj", "json", "3dm"]
SKIPPED = {".txt", ".md", ".tsv"}
TIMEOUT = 300


def meshed(chordal: str, path: Path, mesh: Path) -> tuple[int, dict | None, str]:
    """Exit, report, and the last sentence of one run."""
    report = mesh.with_suffix(".json")
    report.unlink(missing_ok=True)
    command = [chordal, "mesh", path, "-o", mesh, "--sew", "auto", "--report", report, "-q"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        return 124, None, f"over {TIMEOUT} s"
    last = (done.stderr.strip().splitlines() or [""])[-1].split(": ", 2)[-1]
    return done.returncode, json.loads(report.read_text()) if report.exists() else None, last


def row(name: str, expected: str, code: int, told: dict | None, last: str) -> str:
    if told is None:
        return f"| {name} | | {expected} | | | | | | {code}: {last} |"
    errors = [p["message"] for p in told["problems"] if p["severity"] == "error"]
    shells, proven = told["shells"], told["proven_error"]
    cells = [name, told["faces"]["total"], expected, told["triangles"], f"{told['options']['tolerance']:.3g}",
             "none" if proven is None else f"{proven:.3g}", f"{told['max_edge_gap']:.1e}",
             f"{shells['closed_in_file'] - shells['leaking']} of {shells['closed_in_file']}", code if code == 0 else f"{code}: {'; '.join(errors)}"]
    return "| " + " | ".join(map(str, cells)) + " |"


def main() -> None:
    parser = parser_of(__doc__)
    add_models(parser, "folder with one folder per format")
    add_binary(parser)
    parser.add_argument("--out", type=Path, metavar="TABLE.md", help="write the table here, too")
    args = parser.parse_args()
    head = [
        "file",
        "faces",
        "in the index",
        "triangles",
        "tolerance, mm",
        "proven error, mm",
        "gap, mm",
        "watertight",
        "exit",
    ]
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    print("\n".join(lines))
    expected = faces_of_index(args.models / "INDEX.tsv")
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder) / "mesh.ply"
        for kind in FOLDERS:
            for path in sorted(p for p in (args.models / kind).glob("*") if p.suffix not in SKIPPED):
                name = f"{kind}/{path.name}"
                lines.append(row(name, expected.get(name, ""), *meshed(args.binary, path, mesh)))
                print(lines[-1], flush=True)
                mesh.unlink(missing_ok=True)
    if args.out:
        args.out.write_text("\n".join(lines) + "\n", encoding="utf-8")


def faces_of_index(index: Path) -> dict[str, str]:
    """Faces by kind/name, as another kernel counts them."""
    if not index.exists():
        return {}
    with index.open(encoding="utf-8") as file:
        return {
            f"{row['kind']}/{row['name']}": row["occ_faces"] for row in csv.DictReader(file, delimiter="\t")
        }


if __name__ == "__main__":
    main()
