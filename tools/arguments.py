"""Command-line arguments that the measuring tools share."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def parser_of(documentation: str | None) -> argparse.ArgumentParser:
    """A parser whose help is the module's documentation as it stands."""
    return argparse.ArgumentParser(
        description=documentation, formatter_class=argparse.RawDescriptionHelpFormatter
    )


def add_binary(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--binary",
        type=Path,
        metavar="PROGRAM",
        default=Path(os.environ.get("CHORDAL", ROOT / "target" / "release" / "chordal")),
        help="the program `chordal` [default: $CHORDAL, else target/release/chordal of this repository]",
    )


def add_models(parser: argparse.ArgumentParser, what: str = "folder with STEP files") -> None:
    """MODELS: an argument, or the environment variable CHORDAL_MODELS."""
    known = os.environ.get("CHORDAL_MODELS")
    parser.add_argument(
        "models",
        type=Path,
        metavar="MODELS",
        nargs="?" if known else None,
        default=known and Path(known),
        help=f"{what} [default: $CHORDAL_MODELS]",
    )


def add_verifier(parser: argparse.ArgumentParser) -> None:
    """--verify: an argument, or the environment variable CHORDAL_VERIFIER; without either nothing is
    measured."""
    known = os.environ.get("CHORDAL_VERIFIER")
    parser.add_argument(
        "--verify",
        type=Path,
        metavar="VERIFIER.py",
        default=known and Path(known),
        help="measure every mesh with this module (tools/README.md) [default: $CHORDAL_VERIFIER]",
    )


def add_out(parser: argparse.ArgumentParser, default: str, what: str) -> None:
    parser.add_argument("--out", type=Path, default=Path(default), help=f"{what} [default: {default}]")
