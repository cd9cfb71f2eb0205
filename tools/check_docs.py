#!/usr/bin/env python3
"""Checks the Markdown files of a folder: links, anchors and the width of lines. Needs Python and git only.

    tools/check_docs.py [FOLDER]

Every relative link and picture must lead to a file, every `#anchor` to a heading, and no line may be wider
than 110 columns. Prints one line for each fault and exits with 1 if there is one.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

# As wide as the code (`max_width` in rustfmt.toml).
COLUMNS = 110
LINK = re.compile(r"\]\(([^)\s]+)\)|^\[[^\]]+\]: (\S+)$", re.MULTILINE)
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, nargs="?", default=Path(__file__).resolve().parent.parent)
    folder = parser.parse_args().folder
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", "*.md"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()
    files = [folder / name for name in listed if (folder / name).exists()]
    faults = [
        f"{file.relative_to(folder)}{fault}"
        for file in files
        for fault in wide_lines(file) + broken_links(file)
    ]
    print(
        "\n".join(faults)
        or f"{len(files)} documents: links lead somewhere, lines are at most {COLUMNS} columns wide"
    )
    return 1 if faults else 0


def wide_lines(file: Path) -> list[str]:
    lines = file.read_text(encoding="utf-8").splitlines()
    return [f":{number}: {len(line)} columns" for number, line in enumerate(lines, 1) if len(line) > COLUMNS]


def broken_links(file: Path) -> list[str]:
    """One line for each link of the file that leads nowhere."""
    faults = []
    text = FENCE.sub("", file.read_text(encoding="utf-8"))
    for target in (inline or reference for inline, reference in LINK.findall(text)):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        goal = (file.parent / path) if path else file
        if not goal.exists():
            faults.append(f": {target}: no such file")
        elif anchor and goal.suffix == ".md" and anchor not in anchors(goal):
            faults.append(f": {target}: no such heading")
    return faults


def anchors(file: Path) -> set[str]:
    """Headings as GitHub names them: lower case, without punctuation, blanks to hyphens."""
    headings = re.findall(r"^#+ (.*)$", FENCE.sub("", file.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


if __name__ == "__main__":
    sys.exit(main())
