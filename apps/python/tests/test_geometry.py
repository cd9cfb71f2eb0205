"""Surfaces and curves."""

from __future__ import annotations

import numpy as np
import pytest

import chordal


def dome(weights: bool = False) -> chordal.Surface:
    """A bicubic surface with an inner knot along u."""
    u, v = np.meshgrid(np.linspace(0, 4, 5), np.linspace(0, 3, 4), indexing="ij")
    points = np.stack([u, v, np.sin(u) + 0.3 * v * v], axis=-1)
    knots_u = [0, 0, 0, 0, 0.5, 1, 1, 1, 1]
    net = 1 + 0.3 * np.cos(u * v) if weights else None
    return chordal.Surface.nurbs((3, 3), knots_u, [0, 0, 0, 0, 1, 1, 1, 1], points, net)


@pytest.mark.parametrize("weights", [False, True])
def test_derivatives_are_those_of_the_points(weights: bool) -> None:
    surface = dome(weights)
    uv = np.random.default_rng(1).uniform(0.05, 0.95, (50, 2))
    uv = uv[np.abs(uv[:, 0] - 0.5) > 1e-3]
    all_of = surface.derivatives(uv)
    assert all_of.shape == (len(uv), 6, 3) and np.array_equal(all_of[:, 0], surface.evaluate(uv))
    h = 1e-5
    du, dv = np.array([h, 0]), np.array([0, h])
    assert np.allclose((surface.evaluate(uv + du) - surface.evaluate(uv - du)) / (2 * h), all_of[:, 1], atol=1e-6)
    assert np.allclose((surface.evaluate(uv + dv) - surface.evaluate(uv - dv)) / (2 * h), all_of[:, 2], atol=1e-6)
    ahead, behind = surface.derivatives(uv + du), surface.derivatives(uv - du)
    assert np.allclose((ahead[:, 1] - behind[:, 1]) / (2 * h), all_of[:, 3], atol=1e-4)
    assert np.allclose((ahead[:, 2] - behind[:, 2]) / (2 * h), all_of[:, 4], atol=1e-4)
    normals = surface.normals(uv)
    assert np.allclose(np.linalg.norm(normals, axis=1), 1)
    assert np.allclose(np.einsum("ij,ij->i", normals, all_of[:, 1]), 0, atol=1e-9)


def test_shapes_are_kept() -> None:
    surface = dome()
    grid = np.stack(np.meshgrid(np.linspace(0, 1, 4), np.linspace(0, 1, 6), indexing="ij"), axis=-1)
    assert surface.evaluate(grid).shape == (4, 6, 3)
    assert surface.evaluate([0.5, 0.5]).shape == (3,)
    uv, distance = surface.invert(surface.evaluate(grid))
    assert uv.shape == (4, 6, 2) and distance.shape == (4, 6)
    assert np.allclose(uv, grid, atol=1e-6) and distance.max() < 1e-9


def test_bezier_patches_are_the_surface() -> None:
    surface = dome(weights=True)
    patches = surface.bezier_patches()
    assert len(patches) == 2
    for patch in patches:
        (u0, u1), (v0, v1) = patch.uv_range
        assert patch.points.shape == (4, 4, 3) and patch.weights is not None and patch.weights.shape == (4, 4)
        ends = surface.evaluate([[u0, v0], [u0, v1], [u1, v0], [u1, v1]])
        assert np.allclose(ends, patch.points[[0, 0, 3, 3], [0, 3, 0, 3]])


def test_knots_and_points() -> None:
    surface = dome(weights=True)
    uv = np.random.default_rng(2).uniform(0, 1, (20, 2))
    finer = surface.insert_knot_u(0.25).insert_knot_v(0.7, 2)
    assert finer.points.shape == (6, 6, 3) and len(finer.knots_u) == len(surface.knots_u) + 1
    assert np.allclose(finer.evaluate(uv), surface.evaluate(uv))
    moved = surface.with_points(surface.points + [1, 2, 3])
    assert np.allclose(moved.evaluate(uv), surface.evaluate(uv) + [1, 2, 3])
    piece = surface.piece(((0.2, 0.6), (0, 0.5)))
    assert piece.domain == ((0.2, 0.6), (0, 0.5))
    assert np.allclose(piece.evaluate([0.3, 0.4]), surface.evaluate([0.3, 0.4]))


def test_elementary_surfaces(bracket: chordal.Model) -> None:
    surfaces = [face.surface for face in bracket.faces]
    (cylinder, *_) = [surface for surface in surfaces if surface is not None and surface.kind == "cylinder"]
    assert cylinder.periods[0] == pytest.approx(2 * np.pi)
    box = ((0.0, 1.0), (0.0, 2.0))
    form = cylinder.to_nurbs(box)
    assert form.kind == "nurbs" and form.degree == (2, 1)
    _, distance = cylinder.invert(form.evaluate(np.random.default_rng(3).uniform([0, 0], [1, 2], (30, 2))))
    assert distance.max() < 1e-9
    with pytest.raises(chordal.RequestError, match="no knots"):
        cylinder.points


def test_what_does_not_fit_is_refused() -> None:
    points = np.zeros((3, 3, 3))
    knots = [0, 0, 0, 1, 1, 1]
    for given in [
        ((2, 2), [0, 0, 1, 1], knots, points),
        ((2, 2), knots, [0, 0, 0, 1, 0, 1], points),
        ((2, 2), knots, knots, points[:, :, :2]),
        ((2, 2), knots, knots, points[0]),
        ((0, 2), knots, knots, points),
        ((2, 2), knots, knots, points * np.nan),
        ((2, 2), knots, knots, "points"),
        ((2, 2), knots, knots, points, np.zeros((3, 3))),
    ]:
        with pytest.raises(chordal.RequestError):
            chordal.Surface.nurbs(*given)  # type: ignore[arg-type]
    with pytest.raises(chordal.RequestError):
        dome().evaluate([1, 2, 3])


def test_curves() -> None:
    points = np.array([[0, 0, 0], [1, 2, 0], [3, 2, 1], [4, 0, 0], [5, -1, 2.0]])
    curve = chordal.Curve.nurbs(3, [0, 0, 0, 0, 0.4, 1, 1, 1, 1], points, [1, 2, 1, 1, 1])
    t = np.linspace(0.01, 0.99, 23)
    jets = curve.derivatives(t)
    assert jets.shape == (23, 3, 3) and np.array_equal(jets[:, 0], curve.evaluate(t))
    h = 1e-6
    assert np.allclose((curve.evaluate(t + h) - curve.evaluate(t - h)) / (2 * h), jets[:, 1], atol=1e-5)
    found, distance = curve.invert(curve.evaluate(t))
    assert np.allclose(found, t, atol=1e-6) and distance.max() < 1e-9
    assert np.allclose(curve.insert_knot(0.7).evaluate(t), curve.evaluate(t))
    pieces = curve.bezier_pieces()
    assert [piece.shape for piece, _ in pieces] == [(4, 3), (4, 3)]
    assert pieces[0][1] == (0, 0.4) and np.allclose(pieces[1][0][-1], points[-1])


def test_geomdl() -> None:
    pytest.importorskip("geomdl")
    from geomdl import NURBS, BSpline

    theirs = NURBS.Surface()
    theirs.degree_u, theirs.degree_v = 2, 2
    points = [[float(i), float(j), float(i * j % 3)] for i in range(4) for j in range(3)]
    weights = [1 + 0.1 * k for k in range(12)]
    theirs.ctrlpts_size_u, theirs.ctrlpts_size_v = 4, 3
    theirs.ctrlptsw = [[*(x * w for x in p), w] for p, w in zip(points, weights)]
    theirs.knotvector_u, theirs.knotvector_v = [0, 0, 0, 0.5, 1, 1, 1], [0, 0, 0, 1, 1, 1]
    ours = chordal.from_geomdl(theirs)
    uv = np.random.default_rng(4).uniform(0, 1, (20, 2))
    assert np.allclose(ours.evaluate(uv), theirs.evaluate_list(uv.tolist()))
    line = BSpline.Curve()
    line.degree = 2
    line.ctrlpts = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 0.0, 1.0]]
    line.knotvector = [0, 0, 0, 1, 1, 1]
    assert np.allclose(chordal.from_geomdl(line).evaluate([0.3]), [line.evaluate_single(0.3)])
    with pytest.raises(chordal.RequestError):
        chordal.from_geomdl(3)


def test_uv_grids(bracket_mesh: chordal.Mesh) -> None:
    grids = bracket_mesh.uv_grids()
    faces = bracket_mesh.model.faces
    assert grids.shape == (len(faces), 10, 10, 7)
    assert set(np.unique(grids[..., 6])) == {0.0, 1.0}
    assert np.allclose(np.linalg.norm(grids[..., 3:6], axis=-1), 1)
    for face, grid in zip(faces, grids):
        assert face.surface is not None
        assert face.surface.invert(grid[..., :3])[1].max() < 1e-6
        own = bracket_mesh.face_of_triangle == face.index
        outward = bracket_mesh.normals[own].reshape(-1, 3)
        if face.surface.kind == "plane":
            assert np.allclose(grid[..., 3:6], outward[0])
            # The share of points inside is about that of the area.
            corners = bracket_mesh.uv[own]
            sides = corners[:, 1:] - corners[:, :1]
            area = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]).sum() / 2
            box = np.prod(np.ptp(corners.reshape(-1, 2), axis=0))
            fine = bracket_mesh.uv_grids(60, 60)[face.index, ..., 6].mean()
            assert abs(fine - area / box) < 0.06
    with pytest.raises(chordal.RequestError):
        bracket_mesh.uv_grids(0, 10)


def test_edge_grids(bracket: chordal.Model) -> None:
    for edge in bracket.edges:
        assert edge.curve is not None
        grid = edge.curve.grid(10)
        assert grid.shape == (10, 6) and np.allclose(np.linalg.norm(grid[:, 3:], axis=1), 1)
        ends = edge.part.vertices[list(edge.vertices)]
        assert np.allclose(grid[[0, -1], :3], ends, atol=1e-6)
