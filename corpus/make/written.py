"""Lists of files written by hand in a format other than STEP: functions that return the content, and what is
known about it."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

Content = Callable[[], "str | bytes"]


@dataclass(frozen=True)
class Good:
    name: str
    tests: str
    faces: int
    solids: int
    closed: bool
    content: Content


@dataclass(frozen=True)
class Bad:
    """The exit codes that are right, and a phrase that the message or the report must hold."""

    name: str
    tests: str
    exit: str
    phrase: str
    content: Content


GOOD: list[Good] = []
BAD: list[Bad] = []


def good(name: str, tests: str, *, faces: int, solids: int = 0, closed: bool = True) -> Callable[[Content], Content]:
    """Registers a valid file."""

    def register(content: Content) -> Content:
        GOOD.append(Good(name, tests, faces, solids, closed, content))
        return content

    return register


def bad(name: str, tests: str, *, exit: str, phrase: str) -> Callable[[Content], Content]:
    """Registers a broken file."""

    def register(content: Content) -> Content:
        BAD.append(Bad(name, tests, exit, phrase, content))
        return content

    return register


def corpus_folder(documentation: str | None) -> Path:
    """The folder to write into, from the command line; --help prints the script's documentation."""
    parser = argparse.ArgumentParser(description=documentation, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--corpus", type=Path, default=Path(__file__).resolve().parent.parent,
                        help="folder to write into [default: the corpus of this repository]")
    return parser.parse_args().corpus


def write_all(corpus: Path, folder: str, suffix: str, goods: list[Good], bads: list[Bad]) -> None:
    """Writes `corpus/FOLDER` and `corpus/FOLDER/bad` with an INDEX.tsv each."""
    for where, files in ((corpus / folder, goods), (corpus / folder / "bad", bads)):
        where.mkdir(exist_ok=True)
        for file in files:
            content = file.content()
            data = content.encode("ascii") if isinstance(content, str) else content
            (where / (file.name + suffix)).write_bytes(data)
    made_by = [f"{file.content.__module__.replace('__main__', folder + '_files')}.{file.content.__name__}"
               for file in (*goods, *bads)]
    rows = ["name\ttests\tfaces\tsolids\tclosed\tmade_by"]
    rows += [f"{g.name}\t{g.tests}\t{g.faces}\t{g.solids}\t{'yes' if g.closed else 'no'}\t{by}"
             for g, by in zip(goods, made_by)]
    (corpus / folder / "INDEX.tsv").write_text("\n".join(rows) + "\n")
    rows = ["name\ttests\texit\tphrase\tmade_by"]
    rows += [f"{b.name}\t{b.tests}\t{b.exit}\t{b.phrase}\t{by}" for b, by in zip(bads, made_by[len(goods):])]
    (corpus / folder / "bad" / "INDEX.tsv").write_text("\n".join(rows) + "\n")
    print(f"{len(goods)} files, {len(bads)} broken ones")
