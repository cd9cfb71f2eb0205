"""Writes models of random kinds with their right areas: a few for the corpus, or as many as asked for."""

from __future__ import annotations

import argparse
import random
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from rings import Model

Kinds = Mapping[str, tuple[str, Callable[[random.Random], Model]]]


def write(folder: Path, kinds: Kinds, numbers: Callable[[str], Sequence[int]], suffix: str = ".step") -> None:
    """The models `numbers` of each kind, and an index of their areas. A number is a seed."""
    folder.mkdir(exist_ok=True, parents=True)
    rows = ["file\ttests\tarea\tmade_by"]
    module = Path(sys.argv[0]).stem
    for kind, (tests, make) in kinds.items():
        for k in numbers(kind):
            name = f"{kind}_{k}"
            more, area, put = make(random.Random(name))
            put(folder / f"{name}{suffix}")
            rows.append(f"{name}{suffix}\t{tests}{more}\t{area:.9g}\t{module}.{make.__name__}")
    (folder / "INDEX.tsv").write_text("\n".join(rows) + "\n", encoding="utf-8")


def main(title: str | None, folder: Path, kinds: Kinds, kept: int, kept_as_well: Mapping[str, Sequence[int]] = {},
         suffix: str = ".step") -> None:
    parser = argparse.ArgumentParser(description=title, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--variants", nargs=2, metavar=("OUT", "N"))
    parser.add_argument("--kind", action="append", help="only this kind")
    options = parser.parse_args()
    wanted = {k: v for k, v in kinds.items() if not options.kind or k in options.kind}
    if options.variants:
        count = int(options.variants[1])
        write(Path(options.variants[0]), wanted, lambda kind: range(count), suffix)
    else:
        write(folder, kinds, lambda kind: [*range(kept), *kept_as_well.get(kind, [])], suffix)
