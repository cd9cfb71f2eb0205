"""Reading, and what a model shows."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
import pytest

import chordal
from conftest import command_line


def test_a_path_bytes_and_a_file_are_the_same_model(corpus: Path) -> None:
    path = corpus / "bracket.step"
    content = path.read_bytes()
    with path.open("rb") as file:
        models = [chordal.read(path), chordal.read(str(path)), chordal.read(content), chordal.read(file)]
    models.append(chordal.read(io.BytesIO(content), "step"))
    same = [json.loads(model.to_json()) for model in models]
    assert [one.pop("name") for one in same] == ["bracket", "bracket", "model", "bracket", "model"]
    assert all(one == same[0] for one in same)
    assert models[0].source == str(path) and models[2].source == "model"
    assert chordal.read(content, name="bracket").mesh().to_bytes() == models[0].mesh().to_bytes()


def test_a_model_shows_its_content(bracket: chordal.Model) -> None:
    assert bracket.unit == "mm" and "AP" in bracket.format.upper()
    assert len(bracket.faces) == 28 and len(bracket.parts) == 1
    face = bracket.faces[3]
    assert face.index == 3 and face.part.index == 0 and face.entity is not None
    assert face.line is not None and face.line > 1
    assert face.surface is not None and face.surface.kind in {"plane", "cylinder"}
    assert face.loop_count >= 1 and all(3 in bracket.edges[edge].faces for edge in face.edges)
    edge = bracket.edges[face.edges[0]]
    assert edge.curve is not None
    ends = edge.curve.evaluate(edge.curve.range)
    vertices = edge.part.vertices[list(edge.vertices)]
    assert np.allclose(ends, vertices, atol=1e-6)


def test_the_tree_and_the_instances(assembly: chordal.Model) -> None:
    assert len(assembly.instances) == 4 and len(assembly.parts) == 1
    determinants = [np.linalg.det(instance.transform[:3, :3]) for instance in assembly.instances]
    assert min(determinants) < 0 < max(determinants), "some are mirrored"

    def count(nodes: list[chordal.Node]) -> int:
        return sum((node.part is not None) + count(node.children) for node in nodes)

    assert count(assembly.tree) == 4


def test_names_and_colours(corpus: Path) -> None:
    model = chordal.read(corpus / "styles.step")
    colours = [face.color for face in model.faces] + [part.color for part in model.parts]
    found = [colour for colour in colours if colour is not None]
    assert found and all(len(colour) == 4 and 0 <= min(colour) <= max(colour) <= 1 for colour in found)


def test_the_info_is_that_of_the_command_line(corpus: Path, bracket: chordal.Model) -> None:
    shown = command_line("info", "--json", corpus / "bracket.step")
    assert shown.returncode == 0
    assert json.loads(shown.stdout) == bracket.info
    assert bracket.info["max_gap"]["curve_to_surface"] < 1e-6
    assert bracket.problems == bracket.info["problems"]


def test_neighbours_share_edges(bracket: chordal.Model) -> None:
    rows = bracket.parts[0].adjacency()
    assert rows.shape[1] == 3 and len(rows) > 28
    for a, b, edge in rows:
        assert set(bracket.edges[edge].faces) == {a, b}


@pytest.mark.parametrize("pattern", ["iges/*.ig*s", "brep/*.brep", "iv/*.iv", "exchange/*.3dm"])
def test_other_formats(corpus: Path, pattern: str) -> None:
    path = sorted(corpus.glob(pattern))[0]
    model = chordal.read(path)
    assert model.faces
    assert model.mesh().to_bytes() == chordal.read(path.read_bytes(), name=path.stem).mesh().to_bytes()
