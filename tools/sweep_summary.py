"""The table and the summary page of a sweep."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from sweep_judge import SLOW, Verdict

COLUMNS = (
    "repository path bytes exporter verdict finer exit seconds megabytes faces their_faces area their_area area_ratio volume_ratio "
    "box_difference closed_shells leaking crossing_pairs differing_faces their_invalid message"
).split()


def tsv(verdicts: Sequence[Verdict]) -> str:
    return "\t".join(COLUMNS) + "\n" + "".join("\t".join(map(text, line(v))) + "\n" for v in verdicts)


def text(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    return "" if value is None else re.sub(r"\s+", " ", str(value))


def line(v: Verdict) -> list[object]:
    report = v.ours.report or {}
    shells = report.get("shells", {})
    return [
        v.entry.repository,
        v.entry.path,
        report.get("input", {}).get("bytes"),
        v.entry.exporter,
        v.words,
        "finer" if v.finer else "",
        v.ours.exit,
        v.ours.seconds,
        v.ours.memory / 2**20,
        report.get("faces", {}).get("total"),
        v.theirs.get("faces"),
        v.ours.area,
        v.theirs.get("area"),
        v.area_ratio,
        v.volume_ratio,
        v.box_difference,
        shells.get("closed"),
        shells.get("leaking"),
        v.ours.crossing,
        "; ".join(v.differing[:8]),
        len(v.theirs.get("invalid") or []),
        v.ours.message if v.ours.exit != 0 else "",
    ]


def read_explanations(path: Path) -> dict[str, str]:
    """File names and one sentence each."""
    if not path.exists():
        return {}
    with path.open(encoding="utf-8", newline="") as file:
        return {row[0]: row[1] for row in csv.reader(file, delimiter="\t", quoting=csv.QUOTE_NONE) if len(row) == 2}


def markdown(verdicts: Sequence[Verdict], explained: dict[str, str], tolerance: str) -> str:
    with_faces = [v for v in verdicts if not v.no_faces]
    unclean = [v for v in with_faces if not v.clean]
    lines = ["# Sweep", "", *totals(verdicts, with_faces, tolerance), "", "## Not clean", ""]
    lines += [entry_of(v, explained) for v in unclean] or ["None."]
    lines += ["", "## No faces", "", *(f"- {v.name}: {v.ours.message}" for v in verdicts if v.no_faces)]
    return "\n".join(lines) + "\n"


def entry_of(v: Verdict, explained: dict[str, str]) -> str:
    return f"- `{v.name}`: {v.words}. {explained.get(v.name, '**Not explained.**')}"


def totals(verdicts: Sequence[Verdict], with_faces: Sequence[Verdict], tolerance: str) -> list[str]:
    repositories = Counter(v.entry.repository for v in verdicts)
    exits = Counter(v.ours.exit for v in with_faces)
    compared = [v for v in with_faces if v.area_ratio is not None]
    done = sum(v.ours.exit == 0 for v in with_faces)
    return [
        f"Every file meshed at {tolerance} and compared with OpenCASCADE's exact properties.",
        "",
        "| | |",
        "|---|---|",
        f"| files, repositories | {len(verdicts)}, {len(repositories)} |",
        f"| files with faces | {len(with_faces)} |",
        f"| exit code 0 | {done} ({done / max(len(with_faces), 1):.1%}) |",
        f"| exit codes | {', '.join(f'{k}: {n}' for k, n in sorted(exits.items(), key=str))} |",
        f"| faces, triangles | {total(with_faces, 'faces', 'total'):,}, {total(with_faces, 'triangles'):,} |",
        f"| area compared | {len(compared)} |",
        f"| area within 1 % | {sum(abs(v.area_ratio - 1) <= 0.01 for v in compared)} |",
        f"| compared by a finer mesh, since the first one differed | {sum(v.finer is not None for v in with_faces)} |",
        f"| volume compared | {sum(v.volume_ratio is not None for v in with_faces)} |",
        f"| volume within 1 % | {sum(v.volume_ratio is not None and abs(v.volume_ratio - 1) <= 0.01 for v in with_faces)} |",
        f"| box compared | {sum(v.box_difference is not None for v in with_faces)} |",
        f"| box within 1 % of the diagonal | {sum(v.box_difference is not None and v.box_difference <= 0.01 for v in with_faces)} |",
        f"| over {SLOW:g} s | {sum(v.ours.seconds > SLOW for v in with_faces)} |",
        f"| closed shells, of them leaking | {total(with_faces, 'shells', 'closed_in_file'):,}, {total(with_faces, 'shells', 'leaking')} |",
        f"| files with facets that cross | {sum(v.ours.crossing > 0 for v in with_faces)} |",
    ]


def total(verdicts: Sequence[Verdict], *keys: str) -> int:
    result = 0
    for v in verdicts:
        value = v.ours.report or {}
        for key in keys:
            value = value.get(key, {}) if isinstance(value, dict) else {}
        result += value if isinstance(value, int) else 0
    return result
