"""Meshes: arrays, report, files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import chordal
from conftest import command_line


def test_the_arrays(bracket_mesh: chordal.Mesh) -> None:
    mesh = bracket_mesh
    assert mesh.model is mesh.model and mesh.model.mesh(1).model is mesh.model
    count = mesh.report["triangles"]
    shapes = {
        "triangles": ((count, 3), np.uint32),
        "normals": ((count, 3, 3), np.float64),
        "uv": ((count, 3, 2), np.float64),
        "face_of_triangle": ((count,), np.int32),
        "part_of_triangle": ((count,), np.uint32),
        "instance_of_triangle": ((count,), np.uint32),
    }
    for name, (shape, kind) in shapes.items():
        array = getattr(mesh, name)
        assert array.shape == shape and array.dtype == kind, name
        assert not array.flags.writeable and array is getattr(mesh, name), name
    assert mesh.vertices.dtype == np.float64 and mesh.vertices.shape[1] == 3
    with pytest.raises(ValueError):
        mesh.vertices[0, 0] = 1
    assert np.allclose(np.linalg.norm(mesh.normals, axis=2), 1)
    assert mesh.triangles.max() == len(mesh.vertices) - 1


def test_the_arrays_outlive_the_mesh(corpus: Path) -> None:
    vertices = chordal.mesh(corpus / "bracket.step").vertices
    assert np.isfinite(vertices).all() and np.ptp(vertices) > 1


def test_every_edge_of_a_closed_mesh_has_two_triangles(bracket_mesh: chordal.Mesh) -> None:
    assert bracket_mesh.watertight and bracket_mesh.clean
    a = bracket_mesh.triangles
    directed = np.concatenate([a[:, [0, 1]], a[:, [1, 2]], a[:, [2, 0]]])
    forward = {tuple(row) for row in directed.tolist()}
    assert len(forward) == len(directed), "no edge runs twice in one direction"
    assert all((b, a) in forward for a, b in forward)


def test_vertices_lie_on_their_faces(bracket_mesh: chordal.Mesh) -> None:
    mesh = bracket_mesh
    faces = mesh.model.faces
    for number in range(0, len(mesh.triangles), 7):
        surface = faces[mesh.face_of_triangle[number]].surface
        assert surface is not None
        corners = mesh.vertices[mesh.triangles[number]]
        assert np.allclose(surface.evaluate(mesh.uv[number]), corners, atol=1e-6)


def test_the_tolerance_is_kept(bracket: chordal.Model) -> None:
    coarse, fine = bracket.mesh(0.5, None), bracket.mesh(0.005, None)
    assert coarse.proven_error is not None and coarse.proven_error <= 0.5
    assert fine.proven_error is not None and fine.proven_error <= 0.005
    assert len(fine.triangles) > len(coarse.triangles)
    assert fine.report["options"]["angle"] is None and fine.gap < 1e-6


def test_the_ways_to_write_a_tolerance(bracket: chordal.Model) -> None:
    def options(**given: object) -> dict[str, object]:
        found: dict[str, object] = bracket.mesh(**given).report["options"]  # type: ignore[arg-type]
        return found

    assert options() == options(tolerance="0.1%", angle=20)
    assert options(tolerance="50um") == options(tolerance=0.05) == options(tol_linear=0.05)
    assert options(tolerance="0.2%") == options(tol_linear=0.002, tol_relative=True)
    assert options(angle="0.5rad") == options(tol_angular=0.5)


def test_instances(assembly: chordal.Model) -> None:
    mesh = assembly.mesh()
    assert set(mesh.instance_of_triangle.tolist()) == {0, 1, 2, 3}
    counts = np.bincount(mesh.instance_of_triangle)
    assert len(set(counts.tolist())) == 1, "one mesh, placed four times"
    first = mesh.vertices[np.unique(mesh.triangles[mesh.instance_of_triangle == 0])]
    third = mesh.vertices[np.unique(mesh.triangles[mesh.instance_of_triangle == 2])]
    move = assembly.instances[2].transform @ np.linalg.inv(assembly.instances[0].transform)
    assert np.allclose(first @ move[:3, :3].T + move[:3, 3], third)


def test_triangles_of_the_file_have_no_face(corpus: Path) -> None:
    mesh = chordal.mesh(corpus / "tessellated_solid.step")
    copied = mesh.face_of_triangle == -1
    assert copied.any()
    assert np.allclose(mesh.uv[copied], 0)


def test_polylines_run_along_edges(bracket_mesh: chordal.Mesh) -> None:
    lines = bracket_mesh.edges
    assert len(lines) == len(bracket_mesh.model.edges)
    vertices = {tuple(vertex) for vertex in bracket_mesh.vertices.tolist()}
    for line in lines:
        assert all(tuple(point) in vertices for point in line.points.tolist())
        curve = bracket_mesh.model.edges[line.edge].curve
        assert curve is not None and np.allclose(curve.invert(line.points)[1], 0, atol=1e-6)


@pytest.mark.parametrize("format", ["stl", "stl-ascii", "ply", "obj", "glb", "gltf", "3mf"])
def test_files_and_bytes_are_those_of_the_command_line(corpus: Path, tmp_path: Path, format: str) -> None:
    extension = format.partition("-")[0]
    for name in ["bracket", "mapped_items"]:
        source = corpus / f"{name}.step"
        mesh = chordal.mesh(source, output_format=format)
        ours, theirs = tmp_path / "model" / f"out.{extension}", tmp_path / "theirs" / f"out.{extension}"
        for folder in (ours.parent, theirs.parent):
            folder.mkdir(exist_ok=True)
        written = mesh.save(ours, format)
        made = command_line("mesh", source, "-o", theirs, "--format", format)
        assert made.returncode == 0, made.stderr
        assert ours.read_bytes() == theirs.read_bytes()
        assert written.bytes == ours.stat().st_size and written.triangles == len(mesh.triangles)
        if format != "obj":
            assert mesh.to_bytes(format) == theirs.read_bytes()


def test_unit_axis_and_edges(bracket_mesh: chordal.Mesh) -> None:
    plain = bracket_mesh.to_bytes("glb")
    assert bracket_mesh.to_bytes("glb", unit="m", up="y") == plain
    assert bracket_mesh.to_bytes("glb", unit="mm", up="z") != plain
    assert len(bracket_mesh.to_bytes("glb", edges=True)) > len(plain)


def test_the_report_is_that_of_the_command_line(corpus: Path, tmp_path: Path) -> None:
    mesh = chordal.mesh(corpus / "fillets.step", "0.05%", output_format="ply")
    report = tmp_path / "report.json"
    command_line(
        "mesh", corpus / "fillets.step", "--tolerance", "0.05%", "-o", tmp_path / "a.ply", "--report", report
    )
    theirs, ours = json.loads(report.read_text()), dict(mesh.report)
    for key in ("seconds", "peak_memory", "threads", "output"):
        ours.pop(key), theirs.pop(key)
    assert ours == theirs


def test_options_reach_the_mesher(bracket: chordal.Model) -> None:
    mesh = bracket.mesh(
        max_edge="5mm",
        boundary_tolerance=0.02,
        sew="off",
        bound="proven",
        output_format="stl",
        self_intersections=False,
        face_timeout=3,
        file_timeout=0,
        memory=500,
        threads=2,
    )
    options = mesh.report["options"]
    expected = {"max_edge": 5.0, "sewing": "off", "face_timeout": 3.0, "file_timeout": None, "memory": 500_000_000}
    assert {key: options[key] for key in expected} == expected
    assert abs(options["boundary_tolerance"] - 0.02) < 1e-3 and mesh.report["threads"] == 2
    sides = mesh.vertices[mesh.triangles] - mesh.vertices[np.roll(mesh.triangles, 1, axis=1)]
    assert np.linalg.norm(sides, axis=2).max() <= 5 + 1e-9
    assert bracket.mesh(strategy="bezier").report["options"]["strategy"] == "bezier"
