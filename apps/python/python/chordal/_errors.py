"""The exceptions of this package. Each message is the sentence that the command line prints."""

from __future__ import annotations


class Error(Exception):
    """The base of all exceptions of this package."""


class RequestError(Error, ValueError):
    """What the caller requested is not possible: an argument, a tolerance, an output."""


class FileError(Error):
    """The file cannot be used.

    `entity` is the number of the entity in the file that the message is about (`123` for `#123`), `line` its
    line, from 1; `None` where they are not known.
    """

    def __init__(self, message: str, entity: int | None = None, line: int | None = None) -> None:
        super().__init__(message)
        self.entity = entity
        self.line = line

    def __reduce__(self) -> tuple[type[FileError], tuple[str, int | None, int | None]]:
        return type(self), (str(self), self.entity, self.line)


class Cancelled(Error):
    """The progress callback returned `False`."""


class InternalError(Error, RuntimeError):
    """A bug in Chordal, or a system that refuses threads."""
