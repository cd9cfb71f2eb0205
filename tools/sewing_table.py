"""What sewing makes of files without topology: `sewing_table.py CHORDAL FOLDER…` prints a table in Markdown.

Each file is meshed twice, with `--sew off` and with `--sew auto`; the figures are those of the reports.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = {".txt", ".md", ".tsv"}
TIMEOUT = 120


def report(chordal, path, sew, folder):
    """The report of one run, or the program's last sentence."""
    out = Path(folder) / "report.json"
    out.unlink(missing_ok=True)
    command = [chordal, "mesh", path, "-o", Path(folder) / "out.ply", "--report", out, "--sew", sew, "-q"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        return None, f"over {TIMEOUT} s"
    if not out.exists():
        return None, (done.stderr.strip().splitlines() or ["no word"])[-1]
    return json.loads(out.read_text()), ""


def row(chordal, path, folder):
    """One line of the table."""
    name = f"{path.parent.name}/{path.name}"
    sewn, why = report(chordal, path, "auto", folder)
    if sewn is None:
        return f"| {name} | | | | | | | | | {why.split(': ')[-1][:60]} |"
    parts = sewn["sewing"]
    total = lambda key: sum(p[key] for p in parts)
    most = lambda key: max((p[key] for p in parts), default=0.0)
    nearest = [o["nearest"] for p in parts for o in p["open"] if o["nearest"] is not None]
    shells = sewn["shells"]
    cells = [
        name,
        sewn["faces"]["total"],
        f"{most('tolerance'):.1e}",
        total("open_before"),
        total("open_after"),
        f"{most('largest_move'):.1e}",
        f"{min(nearest):.1e}" if nearest else "",
        f"{total('closed_shells')} of {total('shells')}",
        f"{shells['watertight']} of {shells['closed_in_file']}",
        f"{sewn['max_gap']:.1e}" + (f"; {len(sewn['faces']['failed'])} failed" if sewn["faces"]["failed"] else ""),
    ]
    return "| " + " | ".join(str(c) for c in cells) + " |"


def main():
    chordal, *folders = sys.argv[1:]
    print("| file | faces | tolerance, mm | open before | open after | largest move | nearest opening | closed shells | watertight | gap |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted(p for f in folders for p in Path(f).iterdir() if p.suffix not in SKIPPED):
            print(row(chordal, path, folder), flush=True)


main()
