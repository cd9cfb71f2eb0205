#!/usr/bin/env python3
"""Checks that every relative link and picture in the Markdown files of a folder leads to a file, and every `#anchor`
to a heading. Needs Python only.

    tools/check_links.py [FOLDER]

Exits with 1 and prints one line for each broken link.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

LINK = re.compile(r"\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", default=Path(__file__).resolve().parent.parent)
    folder = parser.parse_args().folder
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "*.md"], cwd=folder, capture_output=True,
                            text=True, check=True).stdout.split()
    files = [folder / name for name in listed if (folder / name).exists()]
    faults = [fault for file in files for fault in broken_links(file)]
    print("\n".join(faults) or f"{len(files)} documents: all links lead somewhere")
    return 1 if faults else 0


def broken_links(file: Path) -> list[str]:
    """One line for each link of the file that leads nowhere."""
    faults = []
    for target in LINK.findall(FENCE.sub("", file.read_text(encoding="utf-8"))):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        goal = (file.parent / path) if path else file
        if not goal.exists():
            faults.append(f"{file}: {target}: no such file")
        elif anchor and goal.suffix == ".md" and anchor not in anchors(goal):
            faults.append(f"{file}: {target}: no such heading")
    return faults


def anchors(file: Path) -> set[str]:
    """Headings as GitHub names them: lower case, without punctuation, blanks to hyphens."""
    headings = re.findall(r"^#+ (.*)$", FENCE.sub("", file.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


if __name__ == "__main__":
    sys.exit(main())
