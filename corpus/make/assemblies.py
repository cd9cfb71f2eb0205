"""Instances, names, colours, layers, mirrored and scaled placements, mixed units."""

from __future__ import annotations

import math
from pathlib import Path

import cadquery as cq
from OCP.Quantity import Quantity_Color, Quantity_TOC_RGB
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool

from case import case
from loops import DOWN, O, X, Y, Z, band, block
from occ import write_document
from part21 import Point, Step, real, refs


@case("assembly_200", "200 instances of four coloured, named parts in a tree three levels deep", solids=200,
      closed=True)
def assembly_200(path: Path) -> None:
    tree = Tree()
    screw = cq.Workplane("XY").circle(2).extrude(8).faces(">Z").workplane().circle(4).extrude(3)
    nut = cq.Workplane("XY").polygon(6, 8).extrude(3).faces(">Z").workplane().hole(4)
    washer = tree.part("washer", cq.Workplane("XY").circle(5).circle(2.2).extrude(1), (0.9, 0.7, 0.1))
    cap = tree.part("cap", cq.Workplane("XY").box(9, 9, 2).edges("|Z").fillet(2), (0.1, 0.2, 0.8))
    screw_part, nut_part = tree.part("screw", screw, (0.5, 0.5, 0.5)), tree.part("nut", nut, (0.8, 0.1, 0.1))
    joint = tree.assembly("joint", [(screw_part, cq.Location()), (washer, cq.Location((0, 0, 7))),
                                    (nut_part, cq.Location((0, 0, 1))), (cap, cq.Location((0, 0, -2))),
                                    (washer, cq.Location((0, 0, -0.5)))])
    row = tree.assembly("row of 8", [(joint, cq.Location((14 * i, 0, 0), (0, 0, 1), 15 * i)) for i in range(8)])
    tree.assembly("panel", [(row, cq.Location((0, 16 * j, 3 * j), (1, 0, 0), 5 * j)) for j in range(5)])
    write_document(tree.doc, path)


class Tree:
    """An XCAF document in which every part and assembly is defined once."""

    def __init__(self) -> None:
        self.doc = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
        self.shapes = XCAFDoc_DocumentTool.ShapeTool_s(self.doc.Main())
        self.colours = XCAFDoc_DocumentTool.ColorTool_s(self.doc.Main())

    def part(self, name: str, work: cq.Workplane, colour: tuple[float, float, float]) -> TDF_Label:
        label = self.shapes.AddShape(work.val().wrapped, False)
        self.colours.SetColor(label, Quantity_Color(*colour, Quantity_TOC_RGB), XCAFDoc_ColorSurf)
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
        return label

    def assembly(self, name: str, children: list[tuple[TDF_Label, cq.Location]]) -> TDF_Label:
        label = self.shapes.NewShape()
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
        for k, (child, location) in enumerate(children):
            component = self.shapes.AddComponent(label, child, location.wrapped)
            TDataStd_Name.Set_s(component, TCollection_ExtendedString(f"{name}.{k}"))
        self.shapes.UpdateAssemblies()
        return label


def hand(s: Step) -> str:
    """A solid that differs from its mirror image."""
    prism = [(0, 0), (12, 0), (12, 3), (4, 3), (4, 8), (0, 8)]
    low, high = ([(x, y, z) for x, y in prism] for z in (0, 5))
    n = len(prism)
    sides = [s.flat([low[i], low[(i + 1) % n], high[(i + 1) % n], high[i]]) for i in range(n)]
    return s.solid([*sides, s.flat(low[::-1]), s.flat(high)])


def mapped(s: Step, source: str, target: str) -> str:
    return s.add(f"MAPPED_ITEM('',{source},{target})")


def operator(s: Step, origin: Point, scale: float, x: Point, y: Point, z: Point) -> str:
    """Moves, turns, scales and, where x, y, z are left-handed, mirrors."""
    return s.add(f"CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',{s.direction(x)},{s.direction(y)},{s.point(origin)},"
                 f"{real(scale)},{s.direction(z)})")


@case("mapped_items", "one solid placed by mapped items: moved, scaled by 3, mirrored, mirrored and scaled", solids=4,
      closed=True, faces=32)
def mapped_items(path: Path) -> None:
    s = Step(path.stem)
    shape = s.add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('hand',({s.axes()},{hand(s)}),{s.context})")
    source = s.add(f"REPRESENTATION_MAP({s.axes()},{shape})")
    mirror = (-1, 0, 0)
    items = [mapped(s, source, s.axes((0, 0, 0), Z, X)),
             mapped(s, source, operator(s, (30, 0, 0), 3, X, Y, Z)),
             mapped(s, source, operator(s, (0, 30, 0), 1, mirror, Y, Z)),
             mapped(s, source, operator(s, (0, 60, 0), 0.5, Y, X, Z))]
    s.part([s.axes(), *items], "SHAPE_REPRESENTATION")
    s.write(path)


@case("mapped_cylinder_mirrored", "a mirrored and scaled round part: curved faces under a mirror", solids=2,
      closed=True, faces=6)
def mapped_cylinder_mirrored(path: Path) -> None:
    s = Step(path.stem)
    low, high = s.ring(O, Z, X, 6), s.ring((0, 0, 15), Z, X, 3)
    side = band(s, s.elementary("CONICAL_SURFACE", O, DOWN, X, 6, math.atan2(3, 15)), (low, True), (high, False))
    solid = s.solid([side, s.disc(low, False, O, DOWN, X), s.disc(high, True, (0, 0, 15), Z, X)])
    shape = s.add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('peg',({s.axes()},{solid}),{s.context})")
    source = s.add(f"REPRESENTATION_MAP({s.axes()},{shape})")
    items = [mapped(s, source, operator(s, (0, 0, 0), 1, X, Y, (0, 0, -1))),
             mapped(s, source, operator(s, (30, 0, 0), 2, X, (0, 0, 1), Y))]
    s.part([s.axes(), *items], "SHAPE_REPRESENTATION")
    s.write(path)


@case("mixed_units", "a part in inches with angles in degrees, placed twice in an assembly in millimetres", solids=3,
      closed=True, faces=12)
def mixed_units(path: Path) -> None:
    s = Step(path.stem)
    inches = s.new_context("inch", degrees=True)
    low, high = s.ring(O, Z, X, 0.5), s.ring((0, 0, 1), Z, X, 0.25)
    angle = math.degrees(math.atan2(0.25, 1))
    side = band(s, s.elementary("CONICAL_SURFACE", O, DOWN, X, 0.5, angle), (low, True), (high, False))
    peg = s.solid([side, s.disc(low, False, O, DOWN, X), s.disc(high, True, (0, 0, 1), Z, X)], "peg")
    origin = s.axes()
    peg_part = s.part([origin, peg], name="peg (inch)", context=inches)
    plate_origin = s.axes()
    plate = s.part([plate_origin, s.solid(block(s, (-20, -20, -5), (60, 20, 0)), "plate")], name="plate (mm)")
    first, second, base = s.axes(), s.axes((40, 0, 0), Z, Y), s.axes()
    top = s.part([first, second, base], "SHAPE_REPRESENTATION", name="assembly (mm)")
    s.place(top, plate, plate_origin, base, "plate")
    s.place(top, peg_part, origin, first, "peg 1")
    s.place(top, peg_part, origin, second, "peg 2")
    s.write(path)


@case("metres", "a part in metres", solids=1, closed=True, faces=6)
def metres(path: Path) -> None:
    s = Step(path.stem, unit="m")
    s.part([s.axes(), s.solid(block(s, O, (0.2, 0.1, 0.05)))])
    s.write(path)


def colour(s: Step, r: float, g: float, b: float) -> str:
    """A surface style of one colour."""
    rgb = s.add(f"COLOUR_RGB('',{real(r)},{real(g)},{real(b)})")
    fill = s.add(f"FILL_AREA_STYLE('',({s.add(f'FILL_AREA_STYLE_COLOUR({chr(39) * 2},{rgb})')}))")
    side = s.add(f"SURFACE_SIDE_STYLE('',({s.add(f'SURFACE_STYLE_FILL_AREA({fill})')}))")
    usage = s.add(f"SURFACE_STYLE_USAGE(.BOTH.,{side})")
    return s.add(f"PRESENTATION_STYLE_ASSIGNMENT(({usage}))")


@case("styles", "a coloured solid, one face with an overriding style, one of a named colour; a layer", solids=1,
      closed=True, faces=6)
def styles(path: Path) -> None:
    s = Step(path.stem)
    faces = block(s, O, (10, 6, 3))
    solid = s.solid(faces, "painted")
    s.part([s.axes(), solid])
    whole = s.add(f"STYLED_ITEM('',({colour(s, 0.2, 0.4, 0.9)}),{solid})")
    top = s.add(f"OVER_RIDING_STYLED_ITEM('',({colour(s, 0.9, 0.1, 0.1)}),{faces[-1]},{whole})")
    green = s.add("DRAUGHTING_PRE_DEFINED_COLOUR('green')")
    fill = s.add(f"FILL_AREA_STYLE('',({s.add(f'FILL_AREA_STYLE_COLOUR({chr(39) * 2},{green})')}))")
    side = s.add(f"SURFACE_SIDE_STYLE('',({s.add(f'SURFACE_STYLE_FILL_AREA({fill})')}))")
    usage = s.add(f"SURFACE_STYLE_USAGE(.BOTH.,{side})")
    front = s.add(f"STYLED_ITEM('',({s.add(f'PRESENTATION_STYLE_ASSIGNMENT(({usage}))')}),{faces[0]})")
    s.add(f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',{refs([whole, top, front])},{s.context})")
    s.add(f"PRESENTATION_LAYER_ASSIGNMENT('painted things','',({solid}))")
    s.write(path)
