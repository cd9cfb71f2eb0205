"""Exceptions: their classes, their sentences, their entity and line."""

from __future__ import annotations

import io
import logging
import pickle
from pathlib import Path

import pytest

import chordal
from conftest import command_line


def sentence(*arguments: object) -> str:
    """What the command line prints, without its name."""
    failed = command_line(*arguments)
    assert failed.returncode == 2
    return failed.stderr.strip().removeprefix("chordal: ")


def test_the_hierarchy() -> None:
    for error in (chordal.RequestError, chordal.FileError, chordal.Cancelled, chordal.InternalError):
        assert issubclass(error, chordal.Error)
    assert issubclass(chordal.RequestError, ValueError)


def test_a_missing_file(tmp_path: Path) -> None:
    path = tmp_path / "none.step"
    with pytest.raises(chordal.FileError) as caught:
        chordal.read(path)
    assert str(caught.value) == sentence("info", path)
    assert caught.value.entity is None and caught.value.line is None


def test_the_sentences_are_those_of_the_command_line(corpus: Path, tmp_path: Path) -> None:
    bad = [path for path in sorted((corpus / "bad").iterdir()) if path.is_file()]
    compared = 0
    for path in bad[:40]:
        try:
            chordal.mesh(path)
        except chordal.Error as error:
            assert str(error) == sentence("mesh", path, "-o", tmp_path / "out.glb")
            compared += 1
    assert compared > 0


def test_an_error_has_its_line() -> None:
    text = b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=CARTESIAN_POINT('',(0.,0.,0.));\nENDSEC;\nEND-ISO-10303-21;\n"
    with pytest.raises(chordal.FileError) as caught:
        chordal.read(text)
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value) and again.line == caught.value.line


@pytest.mark.parametrize(
    "given",
    [
        {"tolerance": "0"},
        {"tolerance": -1},
        {"tolerance": "5 parsec"},
        {"tolerance": float("nan")},
        {"angle": "twenty"},
        {"max_edge": 0},
        {"bound": "guessed"},
        {"strategy": "magic"},
        {"edge_method": "magic"},
        {"output_format": "jt"},
        {"threads": 0},
        {"face_timeout": -1},
        {"sew": "perhaps"},
        {"tol_relative": True},
        {"tolerance": 1, "tol_linear": 1},
        {"angle": 1, "tol_angular": 1},
        {"tolerance": 1e-300},
    ],
)
def test_requests_that_are_not_possible(bracket: chordal.Model, given: dict[str, object]) -> None:
    with pytest.raises(chordal.RequestError) as caught:
        bracket.mesh(**given)  # type: ignore[arg-type]
    text = str(caught.value)
    assert "\n" not in text and len(text) > 15


def test_unknown_options_are_refused(bracket: chordal.Model) -> None:
    with pytest.raises(TypeError):
        bracket.mesh(tolerence=1)  # type: ignore[call-arg]


def test_an_extension_that_cannot_be_written(bracket_mesh: chordal.Mesh, corpus: Path, tmp_path: Path) -> None:
    path = tmp_path / "out.jt"
    with pytest.raises(chordal.RequestError) as caught:
        bracket_mesh.save(path)
    assert str(caught.value) == sentence("mesh", corpus / "bracket.step", "-o", path)
    with pytest.raises(chordal.RequestError):
        bracket_mesh.to_bytes("jt")
    with pytest.raises(chordal.RequestError):
        bracket_mesh.save(tmp_path / "no folder" / "out.glb")
    assert list(tmp_path.iterdir()) == []


def test_sources_of_a_wrong_kind() -> None:
    with pytest.raises(TypeError):
        chordal.read(3)  # type: ignore[arg-type]
    with pytest.raises(chordal.RequestError):
        chordal.read(io.StringIO("text"))  # type: ignore[arg-type]
    with pytest.raises(chordal.RequestError):
        chordal.read(b"", format="dwg")


def test_problems_are_logged(corpus: Path, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, logger="chordal"):
        mesh = chordal.mesh(corpus / "open_shell.step")
        chordal.mesh(corpus / "bracket.step")
    texts = [record.getMessage() for record in caplog.records]
    assert any("bracket.step" in text and "triangles" in text for text in texts)
    for severity, text in mesh.problem_sentences():
        assert any(text in found for found in texts), severity
