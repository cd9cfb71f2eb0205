"""The types: mypy --strict on the package and these tests; the stub is that of the module."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import chordal

PACKAGE = Path(chordal.__file__).parent
CONFIG = str(Path(__file__).parents[1] / "pyproject.toml")


def run(*arguments: str) -> None:
    command = [sys.executable, "-m", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, cwd=Path(__file__).parent, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_mypy() -> None:
    pytest.importorskip("mypy")
    tests = sorted(path.name for path in Path(__file__).parent.glob("*.py"))
    run("mypy", "--strict", "--config-file", CONFIG, "-p", "chordal")
    run("mypy", "--strict", "--config-file", CONFIG, *tests)


def test_the_stub_is_the_module() -> None:
    pytest.importorskip("mypy")
    run("mypy.stubtest", "chordal._native", "--ignore-missing-stub")


def test_the_package_is_typed() -> None:
    assert (PACKAGE / "py.typed").exists() and (PACKAGE / "_native.pyi").exists()
