"""Shapes of OCP (CadQuery, build123d)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import chordal

pytest.importorskip("OCP", reason="cadquery-ocp is not installed")


def drilled_block() -> Any:
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    block = BRepPrimAPI_MakeBox(30.0, 20.0, 10.0).Shape()
    drill = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(12, 9, -1), gp_Dir(0, 0, 1)), 4.0, 12.0).Shape()
    return BRepAlgoAPI_Cut(block, drill).Shape()


def faces(shape: Any) -> list[Any]:
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer

    found: list[Any] = []
    explorer = TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_FACE)
    while explorer.More():
        if not any(explorer.Current().IsSame(other) for other in found):
            found.append(explorer.Current())
        explorer.Next()
    return found


def surface_properties(shape: Any) -> Any:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    found = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, found)
    return found


def volume(shape: Any) -> float:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    found = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, found)
    return float(found.Mass())


def mesh_volume(mesh: chordal.Mesh) -> float:
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def test_faces_keep_their_order_and_the_volume_its_size() -> None:
    shape = drilled_block()
    model = chordal.from_ocp(shape)
    mesh = model.mesh(0.001, None)
    assert mesh.watertight and mesh.clean
    assert mesh_volume(mesh) == pytest.approx(volume(shape), rel=1e-3)
    theirs = faces(shape)
    assert len(theirs) == len(model.faces) == 7
    corners = mesh.vertices[mesh.triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    for number, face in enumerate(theirs):
        properties = surface_properties(face)
        own = mesh.face_of_triangle == number
        assert areas[own].sum() == pytest.approx(properties.Mass(), rel=1e-3)
        centre = properties.CentreOfMass()
        ours = np.average(corners[own].mean(axis=1), axis=0, weights=areas[own])
        assert np.allclose(ours, [centre.X(), centre.Y(), centre.Z()], atol=1e-2)


def test_a_shape_that_a_compound_has_twice() -> None:
    from OCP.BRep import BRep_Builder
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Trsf, gp_Vec
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS_Compound

    def moved(shape: Any, x: float) -> Any:
        by = gp_Trsf()
        by.SetTranslation(gp_Vec(x, 0, 0))
        return shape.Moved(TopLoc_Location(by))

    block, compound, builder = drilled_block(), TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for part in (moved(block, 50), BRepPrimAPI_MakeCylinder(4.0, 9.0).Shape(), moved(block, 100)):
        builder.Add(compound, part)
    mesh = chordal.from_ocp(compound).mesh(0.001, None)
    assert len(mesh.model.faces) == 10 and len(mesh.model.instances) == 3
    theirs = faces(compound)
    assert len(theirs) == 17 and set(mesh.placed_face_of_triangle.tolist()) == set(range(17))
    corners = mesh.vertices[mesh.triangles]
    for number, face in enumerate(theirs):
        own = corners[mesh.placed_face_of_triangle == number]
        areas = np.linalg.norm(np.cross(own[:, 1] - own[:, 0], own[:, 2] - own[:, 0]), axis=1)
        centre = surface_properties(face).CentreOfMass()
        ours = np.average(own.mean(axis=1), axis=0, weights=areas)
        assert np.allclose(ours, [centre.X(), centre.Y(), centre.Z()], atol=1e-2)


def test_a_wrapped_shape_is_unwrapped() -> None:
    class Wrapper:
        wrapped = drilled_block()

    class Workplane:
        def val(self) -> Wrapper:
            return Wrapper()

    assert len(chordal.from_ocp(Wrapper()).faces) == len(chordal.from_ocp(Workplane()).faces) == 7
    with pytest.raises(TypeError):
        chordal.from_ocp("a shape")


def test_the_signature_of_cadquery() -> None:
    vertices, triangles = chordal.tessellate(drilled_block(), 0.01, 0.2)
    assert len(vertices[0]) == 3 and max(max(triangle) for triangle in triangles) == len(vertices) - 1
    again, _ = chordal.tessellate(drilled_block(), tolerance=0.01, angularTolerance=0.2)
    assert again == vertices
