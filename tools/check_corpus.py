#!/usr/bin/env python3
"""Runs the binary on the corpus and on its broken files, and compares with what the two INDEX.tsv files
promise.

    tools/check_corpus.py [--binary PROGRAM] [--corpus corpus] [--tolerance 0.1%] [--timeout 60]

Needs nothing but Python. Exits with 1 where anything differs; one line for each difference.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

from arguments import ROOT, add_binary, parser_of

Index = list[dict[str, str]]


def main() -> int:
    parser = parser_of(__doc__)
    add_binary(parser)
    parser.add_argument("--corpus", type=Path, default=ROOT / "corpus")
    parser.add_argument("--tolerance", default="0.1%")
    parser.add_argument("--timeout", type=float, default=60)
    args = parser.parse_args()
    good, bad = read_index(args.corpus / "INDEX.tsv"), read_index(args.corpus / "bad" / "INDEX.tsv")
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        runner = Runner(args.binary, args.tolerance, args.timeout, Path(folder))
        for entry in good:
            wrong += tell(
                entry["name"], judge_good(entry, *runner.run(args.corpus / f"{entry['name']}.step"))
            )
        for entry in bad:
            wrong += tell(
                f"bad/{entry['name']}",
                judge_bad(entry, *runner.run(args.corpus / "bad" / f"{entry['name']}.step")),
            )
    print(f"{len(good)} files and {len(bad)} broken ones: {wrong} not as promised")
    return 1 if wrong else 0


def read_index(path: Path) -> Index:
    head, *lines = path.read_text(encoding="utf-8").splitlines()
    return [dict(zip(head.split("\t"), line.split("\t"))) for line in lines]


class Runner:
    def __init__(self, binary: Path, tolerance: str, timeout: float, folder: Path) -> None:
        self.binary, self.tolerance, self.timeout, self.folder = binary, tolerance, timeout, folder

    def run(self, model: Path) -> tuple[int | None, str, dict | None]:
        """Exit code (None: time is up), what it said, the report."""
        mesh, report = self.folder / "out.ply", self.folder / "out.json"
        for old in (mesh, report):
            old.unlink(missing_ok=True)
        command = [
            self.binary,
            "mesh",
            model,
            "-o",
            mesh,
            "--tolerance",
            self.tolerance,
            "--report",
            report,
            "--quiet",
        ]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, errors="replace", timeout=self.timeout
            )
        except subprocess.TimeoutExpired:
            return None, f"no result after {self.timeout:g} s", None
        written = json.loads(report.read_text()) if report.exists() else None
        if done.returncode == 2 and mesh.exists():
            return done.returncode, done.stderr + " (and yet a mesh was written)", written
        return done.returncode, done.stderr.strip(), written


def judge_good(entry: dict[str, str], code: int | None, said: str, report: dict | None) -> list[str]:
    """What is not as the index says."""
    if int(entry["faces"]) == 0:
        return [] if code in (0, 1, 2) else [f"exit {code}: {said}"]
    if code != 0 or report is None:
        problems = report["problems"] if report else []
        reasons = [f"{p['entity']}: {p['message']}" for p in problems if p["severity"] == "error"]
        return [f"exit {code}: {'; '.join(reasons[:3]) or said.splitlines()[-1:] or 'nothing said'}"]
    wrong = []
    if report["faces"]["total"] != int(entry["faces"]) and not report["tessellated_input"]:
        wrong.append(f"{report['faces']['total']} faces, not {entry['faces']}")
    if entry["closed"] == "yes" and not report["tessellated_input"]:
        shells = report["shells"]
        if shells["closed_in_file"] < int(entry["solids"]) or shells["leaking"] > 0:
            wrong.append(f"{shells['leaking']} leaking of {shells['closed_in_file']} closed shells, "
                         f"{entry['solids']} solids")
    if report["proven_error"] is not None and report["proven_error"] > report["options"]["tolerance"]:
        wrong.append("proven error over the tolerance")
    return wrong


def judge_bad(entry: dict[str, str], code: int | None, said: str, report: dict | None) -> list[str]:
    wrong = []
    if str(code) not in entry["exit"].split(","):
        wrong.append(f"exit {code}, not {entry['exit']}: {said[:200]}")
    if "panicked" in said or "RUST_BACKTRACE" in said:
        wrong.append(f"a panic: {said[:200]}")
    everything = said + json.dumps({k: v for k, v in (report or {}).items() if k in ("problems",)})
    if code is not None and entry["phrase"].lower() not in everything.lower():
        wrong.append(f"nothing said of `{entry['phrase']}`: {said[:200]}")
    return wrong


def tell(name: str, wrong: list[str]) -> int:
    for line in wrong:
        print(f"{name}: {line}")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
