"""To the classes of other packages."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import chordal


def test_trimesh_says_watertight(bracket_mesh: chordal.Mesh, assembly: chordal.Model) -> None:
    pytest.importorskip("trimesh")
    scene = bracket_mesh.to_trimesh()
    (geometry,) = scene.geometry.values()
    assert geometry.is_watertight and geometry.is_winding_consistent and geometry.volume > 0
    assert set(geometry.face_attributes["cad_face"].tolist()) == set(range(28))
    scene = assembly.mesh().to_trimesh()
    assert len(scene.geometry) == 4 and len({geometry.metadata["instance"] for geometry in scene.geometry.values()}) == 4
    assert all(geometry.is_watertight and geometry.volume > 0 for geometry in scene.geometry.values())


def test_pyvista(bracket_mesh: chordal.Mesh) -> None:
    pytest.importorskip("pyvista")
    data = bracket_mesh.to_pyvista()
    assert data.n_cells == len(bracket_mesh.triangles) and data.is_manifold
    assert np.array_equal(data.cell_data["face"], bracket_mesh.face_of_triangle)


def test_meshio(bracket_mesh: chordal.Mesh) -> None:
    pytest.importorskip("meshio")
    data = bracket_mesh.to_meshio()
    assert np.array_equal(data.cells[0].data, bracket_mesh.triangles)
    assert np.array_equal(data.cell_data["face"][0], bracket_mesh.face_of_triangle)


def test_open3d(bracket_mesh: chordal.Mesh) -> None:
    pytest.importorskip("open3d")
    assert bracket_mesh.to_open3d().is_watertight()


@pytest.mark.parametrize("package", ["trimesh", "pyvista", "open3d", "meshio"])
def test_a_missing_package_is_named(
    bracket_mesh: chordal.Mesh, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    import importlib

    def refuse(name: str, *arguments: Any) -> Any:
        raise ImportError(f"No module named {name!r}")

    monkeypatch.setattr(importlib, "import_module", refuse)
    with pytest.raises(ImportError, match=f"to_{package} needs {package}; install it with `pip install {package}`"):
        getattr(bracket_mesh, f"to_{package}")()
