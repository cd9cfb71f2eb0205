"""Solids that an ordinary CAD kernel writes: primitives with holes, fillets, chamfers, sweeps, lofts."""

from __future__ import annotations

import math
from pathlib import Path

import cadquery as cq

from case import case
from occ import write_shape


def _save(work: cq.Workplane | cq.Shape, path: Path, schema: str = "AP214", pcurves: bool = True) -> None:
    shape = work.val() if isinstance(work, cq.Workplane) else work
    write_shape(shape.wrapped, path, schema, pcurves)


@case("bracket", "the README's model: an L-bracket with ribs, fillets and holes", solids=1, closed=True)
def bracket(path: Path) -> None:
    base = cq.Workplane("XY").box(90, 54, 10, centered=(False, True, False)).edges("|Z and >X").fillet(12)
    wall = cq.Workplane("YZ").rect(54, 64).extrude(10).translate((0, 0, 32)).edges("|X and >Z").fillet(26)
    body = base.union(wall)
    body = body.edges(cq.selectors.BoxSelector((9, -28, 9), (11, 28, 11))).fillet(8)
    rib = cq.Workplane("XZ").polyline([(5, 5), (58, 5), (58, 10), (10, 27), (5, 27)]).close().extrude(4, both=True)
    body = body.union(rib).faces("<Z").workplane(origin=(0, 0, 0)).pushPoints([(72, 15), (72, -15)]).circle(4.5)
    body = body.cutBlind(-10).faces("<X").workplane(origin=(0, 0, 38)).circle(13).extrude(6)
    body = body.faces("<X").workplane(origin=(0, 0, 38)).hole(15)
    counterbores = cq.Workplane("XY").pushPoints([(72, 15), (72, -15)]).circle(8).extrude(4).translate((0, 0, 7))
    body = body.cut(counterbores).clean()
    _save(body.faces("<X").edges().chamfer(1), path)


@case("box_holes", "planes with through holes, a blind hole and a countersink", solids=1, closed=True)
def box_holes(path: Path) -> None:
    box = cq.Workplane("XY").box(40, 30, 12)
    box = box.faces(">Z").workplane().pushPoints([(-12, -7), (-12, 7)]).hole(5)
    box = box.faces(">Z").workplane().center(10, 5).hole(6, 5)
    _save(box.faces(">Z").workplane().center(0, -12).cskHole(4, 8, 82), path)


@case("cylinder_seam_hole", "a cross hole that straddles the seam of a cylinder", solids=1, closed=True)
def cylinder_seam_hole(path: Path) -> None:
    body = cq.Workplane("XY").cylinder(40, 12)
    _save(body.cut(cq.Workplane("YZ").circle(4).extrude(30, both=True)), path)


@case("cone_apex", "a full cone with its apex, pierced by a hole", solids=1, closed=True)
def cone_apex(path: Path) -> None:
    cone = cq.Workplane(cq.Solid.makeCone(15, 0, 30))
    _save(cone.cut(cq.Workplane("XZ").center(0, 10).circle(3).extrude(30, both=True)), path)


@case("cone_truncated", "a truncated cone with an oblique hole", solids=1, closed=True)
def cone_truncated(path: Path) -> None:
    cone = cq.Workplane(cq.Solid.makeCone(20, 8, 25))
    drill = cq.Workplane("XY").circle(3).extrude(80, both=True).rotate((0, 0, 0), (0, 1, 0), 70).translate((0, 0, 12))
    _save(cone.cut(drill), path)


@case("sphere_holes", "a sphere with a hole through a pole and one across the seam", solids=1, closed=True)
def sphere_holes(path: Path) -> None:
    ball = cq.Workplane("XY").sphere(15)
    ball = ball.cut(cq.Workplane("XY").center(2, 1).circle(4).extrude(20))
    _save(ball.cut(cq.Workplane("YZ").circle(3).extrude(20)), path)


@case("sphere_full", "a whole sphere: one face, one seam, two poles", solids=1, closed=True)
def sphere_full(path: Path) -> None:
    _save(cq.Workplane("XY").sphere(10), path)


@case("torus_full", "a whole torus: one face, two seams", solids=1, closed=True)
def torus_full(path: Path) -> None:
    _save(cq.Solid.makeTorus(20, 6), path)


@case("torus_hole", "a torus pierced where its two seams cross", solids=1, closed=True)
def torus_hole(path: Path) -> None:
    body = cq.Workplane(cq.Solid.makeTorus(20, 6))
    _save(body.cut(cq.Workplane("YZ").circle(2.5).extrude(40)), path)


@case("wedge_hole", "a wedge with a hole through its slope", solids=1, closed=True)
def wedge_hole(path: Path) -> None:
    wedge = cq.Workplane(cq.Solid.makeWedge(30, 20, 25, 8, 5, 22, 20))
    _save(wedge.cut(cq.Workplane("XZ").center(15, 12).circle(3).extrude(60, both=True)), path)


@case("fillets", "a box with every edge filleted: cylinders and sphere corners", solids=1, closed=True)
def fillets(path: Path) -> None:
    _save(cq.Workplane("XY").box(30, 20, 10).edges().fillet(3), path)


@case("fillet_torus", "fillets round a boss and a hole: torus bands with seams", solids=1, closed=True)
def fillet_torus(path: Path) -> None:
    body = cq.Workplane("XY").box(40, 40, 8).faces(">Z").workplane().circle(10).extrude(10)
    body = body.edges(cq.selectors.RadiusNthSelector(0)).fillet(2)
    _save(body.faces(">Z").workplane().hole(6).faces(">Z").edges("%CIRCLE").fillet(1), path)


@case("fillet_bspline", "fillets that only a B-spline can hold: a pipe tee", solids=1, closed=True)
def fillet_bspline(path: Path) -> None:
    tee = cq.Workplane("XY").cylinder(50, 10).union(cq.Workplane("YZ").circle(6).extrude(22))
    _save(tee.edges(cq.selectors.BoxSelector((3, -9, -9), (12, 9, 9))).fillet(2), path)


@case("chamfers", "chamfered box and rim: small planes and a narrow cone", solids=1, closed=True)
def chamfers(path: Path) -> None:
    body = cq.Workplane("XY").box(30, 20, 10).edges("|Z").chamfer(2, 3)
    body = body.faces(">Z").workplane().hole(9)
    _save(body.faces(">Z").edges("%CIRCLE").chamfer(1), path)


@case("thread", "a helical sweep of three turns on a rod", solids=2, closed=True)
def thread(path: Path) -> None:
    radius, pitch = 6.0, 2.0
    helix = cq.Wire.makeHelix(pitch, 3 * pitch, radius)
    profile = cq.Workplane("XZ").polyline([(5.9, -0.7), (7.2, -0.15), (7.2, 0.15), (5.9, 0.7)]).close()
    ridge = profile.sweep(cq.Workplane(helix), isFrenet=True)
    rod = cq.Workplane("XY").circle(4).extrude(10).translate((0, 0, -2))
    _save(cq.Compound.makeCompound([ridge.val(), rod.val()]), path)


@case("blade", "a turbine blade lofted through twisted aerofoil sections", solids=1, closed=True)
def blade(path: Path) -> None:
    wires = []
    for i in range(5):
        section = _aerofoil(30 - 3 * i, math.radians(12 * i), 0.12 - 0.01 * i)
        wires.append(cq.Wire.assembleEdges([cq.Edge.makeSpline([cq.Vector(x, y, 18 * i) for x, y in half])
                                            for half in section]))
    _save(cq.Solid.makeLoft(wires), path)


def _aerofoil(chord: float, twist: float, thickness: float) -> list[list[tuple[float, float]]]:
    """Upper and lower side of a cambered four-digit section, leading edge to trailing edge and back."""
    xs = [0.5 * (1 - math.cos(math.pi * k / 10)) for k in range(11)]
    half = [5 * thickness * (0.2969 * math.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
            for x in xs]
    camber = [0.2 * x * (1 - x) for x in xs]
    turn = lambda x, y: (chord * ((x - 0.4) * math.cos(twist) - y * math.sin(twist)),
                         chord * ((x - 0.4) * math.sin(twist) + y * math.cos(twist)))
    upper = [turn(x, c + h) for x, c, h in zip(xs, camber, half)]
    lower = [turn(x, c - h) for x, c, h in zip(xs, camber, half)]
    return [upper, lower[::-1]]


@case("void", "a block with a spherical cavity: BREP_WITH_VOIDS", solids=1, closed=True)
def void(path: Path) -> None:
    _save(cq.Workplane("XY").box(20, 20, 20).cut(cq.Workplane("XY").sphere(6)), path)


@case("far_from_origin", "a filleted part whose coordinates are about 1e6", solids=1, closed=True)
def far_from_origin(path: Path) -> None:
    body = cq.Workplane("XY").box(30, 20, 10).edges("|Z").fillet(3).faces(">Z").workplane().hole(6)
    _save(body.translate((1e6, -2e6, 5e5)), path)


@case("no_pcurves", "a filleted part written without any pcurve", solids=1, closed=True)
def no_pcurves(path: Path) -> None:
    body = cq.Workplane("XY").box(30, 20, 10).edges("|Z or >Z").fillet(2.5).faces(">Z").workplane().hole(6)
    _save(body, path, pcurves=False)


@case("ap203", "the AP203 header and schema", solids=1, closed=True)
def ap203(path: Path) -> None:
    _save(cq.Workplane("XY").box(10, 10, 10).faces(">Z").workplane().hole(4), path, "AP203")


@case("ap242", "the AP242 header and schema", solids=1, closed=True)
def ap242(path: Path) -> None:
    _save(cq.Workplane("XY").box(10, 10, 10).faces(">Z").workplane().hole(4), path, "AP242")


@case("open_shell", "a shell with its lid taken off: open, one boundary", solids=0, closed=False)
def open_shell(path: Path) -> None:
    body = cq.Workplane("XY").box(20, 20, 10).edges("|Z").fillet(3)
    _save(cq.Shell.makeShell(body.faces("not >Z").vals()), path)


@case("elliptic", "an elliptic cylinder and its extrusion surface", solids=1, closed=True)
def elliptic(path: Path) -> None:
    _save(cq.Workplane("XY").ellipse(15, 6).extrude(12), path)


@case("extrusion_bspline", "a surface of linear extrusion of a B-spline", solids=1, closed=True)
def extrusion_bspline(path: Path) -> None:
    points = [(0, 0), (10, 6), (20, -2), (30, 5), (26, 16), (8, 14)]
    _save(cq.Workplane("XY").spline(points, periodic=True).close().extrude(15), path)


@case("revolution_bspline", "a surface of revolution of a B-spline, a vase", solids=1, closed=True)
def revolution_bspline(path: Path) -> None:
    outline = cq.Workplane("XZ").moveTo(0, 0).lineTo(8, 0)
    outline = outline.spline([(12, 10), (6, 20), (9, 30)], includeCurrent=True).lineTo(0, 30).close()
    _save(outline.revolve(360, (0, 0, 0), (0, 1, 0)), path)


@case("revolution_pole", "a revolved B-spline that ends on its axis, turned by 270 degrees", solids=1, closed=True)
def revolution_pole(path: Path) -> None:
    outline = cq.Workplane("XZ").moveTo(0, 0).spline([(10, 4), (8, 14), (0, 20)], includeCurrent=True).close()
    _save(outline.revolve(270, (0, 0, 0), (0, 1, 0)), path)


@case("pipe_elbow", "a hollow pipe with a torus elbow", solids=1, closed=True)
def pipe_elbow(path: Path) -> None:
    route = cq.Workplane("XZ").lineTo(0, 20).radiusArc((15, 35), 15).lineTo(35, 35)
    _save(cq.Workplane("XY").circle(6).circle(4.5).sweep(route), path)


@case("shelled", "a box hollowed to 1.5 mm with rounded edges", solids=1, closed=True)
def shelled(path: Path) -> None:
    _save(cq.Workplane("XY").box(40, 25, 15).edges("|Z").fillet(5).faces(">Z").shell(-1.5), path)


@case("twisted_extrude", "a twisted square prism: four B-spline sides", solids=1, closed=True)
def twisted_extrude(path: Path) -> None:
    _save(cq.Workplane("XY").rect(12, 12).twistExtrude(30, 60), path)


@case("gear", "a small spur gear with 8 teeth", solids=1, closed=True)
def gear(path: Path) -> None:
    points = []
    for i in range(8):
        for part, radius in ((0.0, 10), (0.3, 10), (0.4, 13), (0.9, 13)):
            a = math.tau * (i + part) / 8
            points.append((radius * math.cos(a), radius * math.sin(a)))
    _save(cq.Workplane("XY").polyline(points).close().extrude(5).faces(">Z").workplane().hole(6), path)
