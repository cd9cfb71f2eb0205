#!/usr/bin/env python3
"""Meshes many files and compares each mesh with the exact properties that OpenCASCADE finds.

    tools/sweep.py docs/results/sweep_files.tsv --clones CLONES [--fetch] [--out out/sweep]
    tools/sweep.py FOLDER [--out out/sweep]

The list names public files by repository, commit, path and sha256; no file is kept here. CLONES holds one git
repository each, as owner+name; with --fetch a missing one is fetched from GitHub, that commit only. A folder
is searched for STEP and IGES files.

Every file is meshed by a process of its own, in bounded time. The other kernel (cadquery-ocp) runs in its own
process, too; its answers are kept in --out by sha256, so that a later sweep runs only ours. Writes sweep.tsv
(one line a file) and sweep.md (counts, and one line for each file that is not clean) into --out.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from arguments import add_binary, add_out, parser_of
from sweep_files import Entry, listed, materialise, searched
from sweep_judge import Verdict, judge
from sweep_ours import Run, run_ours
from sweep_summary import markdown, read_explanations, tsv
from sweep_theirs import run_theirs


def main() -> int:
    args = arguments()
    args.out.mkdir(parents=True, exist_ok=True)
    entries = listed(args.source) if args.source.is_file() else searched(args.source)
    entries = [entry for entry in entries if all(part in entry.name for part in args.only)]
    with ThreadPoolExecutor(args.jobs) as pool:
        verdicts = [v for v in pool.map(lambda entry: sweep_one(entry, args), entries) if v is not None]
    verdicts.sort(key=lambda verdict: verdict.name)
    explained = read_explanations(args.explained)
    (args.out / "sweep.tsv").write_text(tsv(verdicts), encoding="utf-8")
    (args.out / "sweep.md").write_text(markdown(verdicts, explained, args.tolerance), encoding="utf-8")
    return 0 if all(v.clean or v.name in explained for v in verdicts) else 1


def arguments() -> argparse.Namespace:
    parser = parser_of(__doc__)
    parser.add_argument("source", type=Path, metavar="LIST|FOLDER", help="a list (.tsv), or a folder with files")
    parser.add_argument("--clones", type=Path, help="folder with the repositories of the list")
    parser.add_argument("--fetch", action="store_true", help="fetch repositories that --clones lacks")
    parser.add_argument("--only", nargs="+", default=[], help="parts of names: only files whose name has all of them")
    parser.add_argument("--ours-only", action="store_true", help="do not run the other kernel: nothing is compared")
    add_binary(parser)
    parser.add_argument("--tolerance", default="0.1%")
    parser.add_argument(
        "--finer", default="0.005%", help="tolerance of a second mesh where the first one's measures differ [default: 0.005%%]"
    )
    parser.add_argument("--jobs", type=int, default=1, help="files at a time [default: 1]")
    parser.add_argument("--seconds", type=float, default=120, help="limit of time of each side per file [default: 120]")
    parser.add_argument(
        "--explained",
        type=Path,
        default=Path(__file__).parent / "sweep_explained.tsv",
        help="files that are known not to be clean, and why [default: tools/sweep_explained.tsv]",
    )
    add_out(parser, "out/sweep", "folder for the tables and for what the other kernel answered")
    return parser.parse_args()


def sweep_one(entry: Entry, args: argparse.Namespace) -> Verdict | None:
    """One file by both sides; None, with a message, where it cannot be had."""
    try:
        path = materialise(entry, args.clones, args.fetch, args.out / "files")
    except (OSError, ValueError) as error:
        print(f"{entry.name}: {error}", file=sys.stderr, flush=True)
        return None
    ours: Run = run_ours(args.binary, path, args.tolerance, args.seconds, args.out / "meshes")
    theirs = {} if args.ours_only else run_theirs(path, entry.sha256, args.seconds, args.out / "theirs")
    verdict = judge(entry, ours, theirs)
    if verdict.differs:
        # A mesh of many small round faces differs because it is coarse; a finer one does not.
        finer = run_ours(args.binary, path, args.finer, args.seconds, args.out / "meshes")
        verdict = judge(entry, ours, theirs, finer)
    print(f"{entry.name}: {verdict.words}", file=sys.stderr, flush=True)
    return verdict


if __name__ == "__main__":
    sys.exit(main())
