#!/usr/bin/env python3
"""Solids taken apart into single faces and sewn again: prints a table in Markdown.

    tools/sewing_apart.py MODELS [--binary PROGRAM] [--out TABLE.md]

Every STEP file of MODELS is written with `convert --unsewn`: each face an island with edges of its own,
nothing shared, nothing called closed. It is read again, sewn with `--sew auto` and meshed at 0.2 % with the
proven bound, as is the model as it came. The figures are those of the reports; *fails* says what the check
asks for and did not get.
"""

import json
import subprocess
import tempfile
from pathlib import Path

from arguments import add_binary, add_models, parser_of

SUFFIXES = {".step", ".stp"}
TIMEOUT = 300
# The check asks for closed shells where the gaps are under this share of the diagonal.
LOOSE = 1e-3


def meshed(chordal: Path, model: Path, folder: Path) -> dict | None:
    """The report of one run."""
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    command = [
        chordal,
        "mesh",
        model,
        "-o",
        folder / "out.ply",
        "--tolerance",
        "0.2%",
        "--sew",
        "auto",
        "--report",
        report,
        "-q",
    ]
    subprocess.run(command, capture_output=True, timeout=TIMEOUT)
    return json.loads(report.read_text()) if report.exists() else None


def row(chordal: Path, model: Path, folder: Path) -> str:
    apart = folder / "apart.json"
    apart.unlink(missing_ok=True)
    subprocess.run([chordal, "convert", model, "--unsewn", "-o", apart], capture_output=True, timeout=TIMEOUT)
    before, after = meshed(chordal, model, folder), meshed(chordal, apart, folder)
    if before is None or after is None:
        return f"| {model.name} |" + " |" * 9 + " no mesh |"
    parts = after["sewing"]
    total = lambda key: sum(p[key] for p in parts)
    most = lambda key: max((p[key] for p in parts), default=0.0)
    shells, again = before["shells"], after["shells"]
    # Tolerances are shares of the diagonal.
    gap = before["max_edge_gap"] / (before["options"]["tolerance"] / 0.002)
    whole = again["leaking"] == 0 and again["closed"] >= shells["closed"]
    fails = "" if whole and total("closed_shells") == total("shells") or not shells["closed_in_file"] else f"gap {gap:.1e} of the diagonal"
    unsound = "yes" if any(p["stage"] == "audit" for p in after["problems"]) else ""
    cells = [model.name, after["faces"]["total"], f"{shells['closed']} of {shells['closed_in_file']}", total("open_before"),
             total("open_after"), f"{most('tolerance'):.1e}", f"{most('largest_move'):.1e}",
             f"{total('closed_shells')} of {total('shells')}", f"{again['closed']} of {again['closed_in_file']}", unsound, fails]
    return "| " + " | ".join(map(str, cells)) + " |"


def main() -> None:
    parser = parser_of(__doc__)
    add_binary(parser)
    add_models(parser)
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    head = [
        "file",
        "faces",
        "closed shells of the file, watertight",
        "open before",
        "open after",
        "tolerance, mm",
        "largest move, mm",
        "closed shells",
        "watertight",
        "unsound",
        "not closed",
    ]
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    with tempfile.TemporaryDirectory() as folder:
        for model in sorted(p for p in args.models.iterdir() if p.suffix.lower() in SUFFIXES):
            lines.append(row(args.binary, model, Path(folder)))
            print(lines[-1], flush=True)
    if args.out:
        args.out.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
