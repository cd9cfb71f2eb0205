"""Writes rows as Markdown and as tab-separated values."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import fields
from pathlib import Path

from measure_row import PROMISES, Row

NOTES_PER_ROW = 12


def write_tables(rows: Sequence[Row], results: Path, described: str) -> None:
    results.parent.mkdir(parents=True, exist_ok=True)
    results.with_name(results.name + ".tsv").write_text(tsv(rows), encoding="utf-8")
    results.with_name(results.name + ".md").write_text(markdown(rows, described), encoding="utf-8")


def tsv(rows: Sequence[Row]) -> str:
    names = [f.name for f in fields(Row) if f.name not in ("notes", "reasons")]
    lines = ["\t".join([*names, *(f"ok_{name}" for name in PROMISES)])]
    for row in rows:
        values = ["" if (v := getattr(row, name)) is None else str(v).replace("\t", " ") for name in names]
        lines.append(
            "\t".join([*values, *({True: "1", False: "0", None: ""}[k] for k in row.promises().values())])
        )
    return "\n".join(lines) + "\n"


def number(value: float | None, form: str = ".3g") -> str:
    return "–" if value is None else format(value, form)


def over(value: float | None, unit: float | None) -> str:
    return "–" if value is None or not unit else f"{value / unit:.3f}"


def over_bound(row: Row) -> str:
    if not row.faces_over_bound:
        return number(row.faces_over_bound, "d")
    return f"{row.faces_over_bound} ({row.faces_over_by_pcurve})"


COLUMNS: list[tuple[str, Callable[[Row], str]]] = [
    ("file", lambda r: r.model),
    ("exit", lambda r: "timeout" if r.exit is None else str(r.exit)),
    ("faces", lambda r: number(r.faces, "d")),
    ("index", lambda r: number(r.faces_index, "d")),
    ("failed", lambda r: number(r.failed, "d")),
    ("zero area", lambda r: number(r.zero_area, "d")),
    ("triangles", lambda r: number(r.triangles, "d")),
    ("bound", lambda r: number(r.lower_bound, ".0f")),
    ("ratio", lambda r: number(r.ratio, ".2f")),
    ("tolerance", lambda r: number(r.tolerance_mm, ".4g")),
    ("proven", lambda r: over(r.proven_error, r.tolerance_mm)),
    ("gap", lambda r: over(r.gap, r.tolerance_mm)),
    ("edge gap", lambda r: over(r.occ_edge_gap, r.tolerance_mm)),
    ("edge tol", lambda r: over(r.occ_edge_tolerance, r.tolerance_mm)),
    ("s→m", lambda r: over(r.s2m, r.tolerance_mm)),
    ("m→s", lambda r: over(r.m2s, r.tolerance_mm)),
    ("missing", lambda r: number(r.missing, "d")),
    ("open", lambda r: number(r.open_edges, "d")),
    ("incons.", lambda r: number(r.inconsistent_edges, "d")),
    ("over bound", lambda r: over_bound(r)),
    ("s", lambda r: number(r.seconds, ".2f")),
]
MARKS = {True: "✓", False: "**✗**", None: "·"}


def markdown(rows: Sequence[Row], described: str) -> str:
    parts = ["# Every model, measured", "", described + ".", "", LEGEND, ""]
    for tolerance in dict.fromkeys(r.tolerance for r in rows):
        chosen = [r for r in rows if r.tolerance == tolerance]
        parts += [f"## Tolerance {tolerance} of the diagonal", "", *totals(chosen), "", *table(chosen), ""]
    parts += ["## One by one", "", *one_by_one(rows)]
    return "\n".join(parts) + "\n"


LEGEND = (
    """*proven*, *gap*, *edge gap*, *edge tol*, *s→m* and *m→s* are in units of the tolerance (given in mm).
    *index*: faces as the models' own index counts them. *bound*: the fewest triangles (`docs/report.md`),
    *ratio* over it. *gap*: how far vertices lie off their surfaces because the file is loose, ours; *edge
    gap* and *edge tol*: the same as the other kernel measures it, and the largest tolerance of an edge as it
    reads the file. *s→m*, *m→s*: measured by the independent verifier, surface to mesh and mesh to surface.
    *open*, *incons.*: edges of shells that the file calls closed, by provenance. *over bound*: faces measured
    over `proven_error + gap`; in brackets those where the file's pcurves are as far off their edges. *s*:
    wall seconds of the whole run. Then the promises:"""
    + "; ".join(f"*{name}*: {meaning}" for name, meaning in PROMISES.items())
    + ". ✓ kept, ✗ broken, · could not be judged."
)


def table(rows: Sequence[Row]) -> list[str]:
    names = [name for name, _ in COLUMNS] + [name.replace("_", " ") for name in PROMISES]
    lines = ["| " + " | ".join(names) + " |", "|---" * len(names) + "|"]
    for row in rows:
        cells = [show(row) for _, show in COLUMNS] + [MARKS[kept] for kept in row.promises().values()]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def totals(rows: Sequence[Row]) -> list[str]:
    meshed = [r for r in rows if r.faces is not None]
    faces = sum(r.faces for r in meshed)
    failed = sum(r.failed for r in meshed)
    bound = sum(r.lower_bound or 0 for r in meshed)
    triangles = sum(r.triangles for r in meshed if r.lower_bound)
    errors = [r.measured / r.tolerance_mm for r in meshed if r.measured and r.tolerance_mm]
    lines = [
        f"- files: {len(rows)}, written: {len(meshed)}, exit 0: {sum(r.exit == 0 for r in rows)}",
        f"- faces: {faces}, failed: {failed} ({100 * failed / max(faces, 1):.3f} %), "
        f"of no area: {sum(r.zero_area for r in meshed)}",
        f"- triangles: {triangles}, over the lower bound: {triangles / max(bound, 1):.3f} in the sum, "
        f"{geometric([r.ratio for r in meshed if r.ratio]):.3f} in the geometric mean",
        f"- measured error over tolerance: {geometric(errors):.3f} in the geometric mean, "
        f"{max(errors, default=math.nan):.3f} at most",
        f"- seconds: {sum(r.seconds for r in rows):.1f}",
    ]
    reasons = sum((r.reasons for r in meshed), Counter())
    by_count = sorted(reasons.items(), key=lambda item: (-item[1], item[0]))
    lines[2:2] = [f"  - {count} × {reason}" for reason, count in by_count[:20]]
    for name, meaning in PROMISES.items():
        kept = [r.promises()[name] for r in rows]
        lines.append(
            f"- {meaning}: kept {kept.count(True)}, broken {kept.count(False)}, not judged {kept.count(None)}"
        )
    return lines


def geometric(values: Sequence[float]) -> float:
    return math.exp(sum(map(math.log, values)) / len(values)) if values else math.nan


def one_by_one(rows: Sequence[Row]) -> list[str]:
    """Broken promises, and every problem that the reports name."""
    lines = []
    for row in rows:
        said = ([f"{row.message}"] if row.exit not in (0, 1) else []) + row.notes
        said += [f"not measured: {row.verify_error}"] if row.verify_error else []
        if not said and not row.broken():
            continue
        lines.append(f"- **{row.model}**, {row.tolerance}: broken: {', '.join(row.broken()) or 'none'}")
        lines += [f"  - {note}" for note in said[:NOTES_PER_ROW]]
        if len(said) > NOTES_PER_ROW:
            lines.append(f"  - … and {len(said) - NOTES_PER_ROW} more")
    return lines or ["No problems."]
