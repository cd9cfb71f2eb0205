"""The list of corpus cases: a function that writes one file, and what is known about that file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

Writer = Callable[[Path], None]


@dataclass(frozen=True)
class Case:
    """One file of the corpus. `faces` counts every instance; None is filled in from the independent kernel."""

    name: str
    tests: str
    solids: int
    closed: bool
    faces: int | None
    write: Writer

    @property
    def made_by(self) -> str:
        return f"{self.write.__module__}.{self.write.__name__}"


@dataclass(frozen=True)
class BadCase:
    """One broken file: the exit codes that are right for it, and a phrase its message or report must hold."""

    name: str
    tests: str
    exit: str
    phrase: str
    write: Writer

    @property
    def made_by(self) -> str:
        return f"{self.write.__module__}.{self.write.__name__}"


CASES: list[Case] = []
BAD_CASES: list[BadCase] = []


def case(name: str, tests: str, *, solids: int, closed: bool, faces: int | None = None) -> Callable[[Writer], Writer]:
    """Registers a valid file."""

    def register(write: Writer) -> Writer:
        CASES.append(Case(name, tests, solids, closed, faces, write))
        return write

    return register


def bad_case(name: str, tests: str, *, exit: str, phrase: str) -> Callable[[Writer], Writer]:
    """Registers a broken file."""

    def register(write: Writer) -> Writer:
        BAD_CASES.append(BadCase(name, tests, exit, phrase, write))
        return write

    return register
