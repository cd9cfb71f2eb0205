#!/usr/bin/env python3
"""Writes docs/problems.md: every code of a problem with its meaning, from the sources in crates/brep/src/issue.

    tools/problem_codes.py [--check]

With --check nothing is written; exits with 1 where the page is out of date. Needs Python only.
"""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path

from arguments import ROOT, parser_of

PAGE = ROOT / "docs" / "problems.md"
SOURCES = ROOT / "crates" / "brep" / "src" / "issue"
STAGES = [
    ("reading", "Reading", "Found in the file. With the severity `error`, geometry may be missing."),
    ("meshing", "Meshing", "Why a face could not be meshed, or not with the requested method."),
    ("auditing", "Audit", "Found in the finished mesh."),
    ("result", "Result", "The sum of all stages, and the writer."),
]
HEAD = """# Problems

The code of every problem in the [report](report.md#problems), by stage. Programs can match on codes: they
stay when sentences are reworded. `tools/problem_codes.py` writes this page from the sources.
"""
# A variant of an enum: its documentation, its name, and, in the table of the readers, its code.
VARIANT = re.compile(r"((?:^ {4}/// .*\n)+) {4}(\w+)(.*)", re.MULTILINE)


def main() -> int:
    parser = parser_of(__doc__)
    parser.add_argument("--check", action="store_true", help="only compare the page with the sources")
    check = parser.parse_args().check
    page = HEAD
    for name, title, what in STAGES:
        entries = codes((SOURCES / f"{name}.rs").read_text(encoding="utf-8"))
        page += f"\n## {title}\n\n{what}\n\n" + "".join(map(entry, entries))
    if not check:
        PAGE.write_text(page, encoding="utf-8")
        return 0
    if not PAGE.exists() or PAGE.read_text(encoding="utf-8") != page:
        print(f"{PAGE} is out of date: run tools/problem_codes.py", file=sys.stderr)
        return 1
    return 0


def codes(source: str) -> list[tuple[str, str]]:
    """Code and meaning of every variant, in the order of the source."""
    by_variant = dict(re.findall(r"::(\w+)(?: ?\{[^}]*\}|\([^)]*\))? => \"([a-z-]+)\"", source))
    found = []
    for match in VARIANT.finditer(source):
        meaning = " ".join(line.strip().removeprefix("///").strip() for line in match[1].splitlines())
        # In the table of the readers the code follows the fields of the variant.
        rest = source[match.end(2) : match.end(2) + 600].split("\n\n")[0]
        following = re.match(r"(?: *\{.*?\})? => \"([a-z-]+)\"", rest, re.DOTALL)
        code = by_variant.get(match[2]) or (following and following[1])
        if code and code not in (known for known, _ in found):
            found.append((code, meaning))
    return found


def entry(found: tuple[str, str]) -> str:
    code, meaning = found
    return textwrap.fill(f"- `{code}`: {meaning}", 110, subsequent_indent="  ", break_on_hyphens=False) + "\n"


if __name__ == "__main__":
    sys.exit(main())
