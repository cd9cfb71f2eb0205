"""What the tests share: the corpus, a mesh, an assembly, the command line."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import chordal

CORPUS = Path(__file__).resolve().parents[3] / "corpus"


@pytest.fixture(scope="session")
def corpus() -> Path:
    return CORPUS


@pytest.fixture(scope="session")
def bracket() -> chordal.Model:
    return chordal.read(CORPUS / "bracket.step")


@pytest.fixture(scope="session")
def bracket_mesh(bracket: chordal.Model) -> chordal.Mesh:
    return bracket.mesh(0.05)


@pytest.fixture(scope="session")
def assembly() -> chordal.Model:
    """One solid placed four times: moved, scaled, mirrored."""
    return chordal.read(CORPUS / "mapped_items.step")


def command_line(*arguments: object) -> subprocess.CompletedProcess[str]:
    """Runs the program of CHORDAL_BINARY, else `python -m chordal`."""
    binary = os.environ.get("CHORDAL_BINARY")
    program = [binary] if binary else [sys.executable, "-m", "chordal"]
    command = [*program, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
