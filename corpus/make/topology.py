"""Shells and sets: faceted, wires, points, several shells, tessellated items."""

from __future__ import annotations

import math
from pathlib import Path

from case import case
from loops import O, X, Y, Z, block
from part21 import AP203, AP242, Point, Step, integers, newell, numbers, refs, unit


def poly_loop(s: Step, points: list[Point], ids: dict[Point, str]) -> str:
    for p in points:
        if p not in ids:
            ids[p] = s.point(p)
    return s.add(f"POLY_LOOP('',{refs([ids[p] for p in points])})")


def facet(s: Step, loops: list[list[Point]], ids: dict[Point, str], planar: bool) -> str:
    """A face of poly loops, with its plane or, as many writers do, without."""
    bounds = [s.bound(poly_loop(s, points, ids), outer=i == 0) for i, points in enumerate(loops)]
    if not planar:
        return s.add(f"FACE('',{refs(bounds)})")
    x = unit([b - a for a, b in zip(loops[0][0], loops[0][1])])
    plane = s.plane(loops[0][0], newell(loops[0]), x)
    return s.add(f"FACE_SURFACE('',{refs(bounds)},{plane},.T.)")


def frame_faces() -> list[list[list[Point]]]:
    """A square frame: its top and bottom have a hole."""
    square = lambda r, z: [(-r, -r, z), (r, -r, z), (r, r, z), (-r, r, z)]
    faces = [[square(10, 4), square(6, 4)[::-1]], [square(10, 0)[::-1], square(6, 0)]]
    for r, inward in ((10, False), (6, True)):
        low, high = square(r, 0), square(r, 4)
        for i in range(4):
            points = [low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]]
            faces.append([points[::-1] if inward else points])
    return faces


def faceted(path: Path, planar: bool) -> None:
    s, ids = Step(path.stem), {}
    faces = [facet(s, loops, ids, planar) for loops in frame_faces()]
    shell = s.add(f"CLOSED_SHELL('',{refs(faces)})")
    s.part([s.axes(), s.add(f"FACETED_BREP('',{shell})")], "FACETED_BREP_SHAPE_REPRESENTATION")
    s.write(path)


@case("faceted", "FACETED_BREP: poly loops on planes, two faces with a hole", solids=1, closed=True, faces=10)
def faceted_planes(path: Path) -> None:
    faceted(path, True)


@case("faceted_no_surface", "FACETED_BREP whose faces are plain FACEs: poly loops and no plane", solids=1, closed=True,
      faces=10)
def faceted_no_surface(path: Path) -> None:
    faceted(path, False)


@case("faceted_one_plane", "FACETED_BREP: a tetrahedron whose faces all name the plane of one of them", solids=1, closed=True,
      faces=4)
def faceted_one_plane(path: Path) -> None:
    s, ids = Step(path.stem), {}
    a, b, c, d = (0, 0, 0), (10, 0, 0), (0, 10, 0), (0, 0, 10)
    plane = s.plane(a, Z, X)
    bounds = [s.bound(poly_loop(s, points, ids), outer=True) for points in ([a, c, b], [a, b, d], [a, d, c], [b, c, d])]
    faces = [s.add(f"FACE_SURFACE('',{refs([bound])},{plane},.T.)") for bound in bounds]
    shell = s.add(f"CLOSED_SHELL('',{refs(faces)})")
    s.part([s.axes(), s.add(f"FACETED_BREP('',{shell})")], "FACETED_BREP_SHAPE_REPRESENTATION")
    s.write(path)


@case("compound_items", "solids within a COMPOUND_REPRESENTATION_ITEM within another one, as a list and as a set", solids=2,
      closed=True, faces=12)
def compound_items(path: Path) -> None:
    s = Step(path.stem)
    solids = [s.solid(block(s, (x, 0, 0), (x + 5, 5, 5))) for x in (0, 10)]
    inner = s.add(f"COMPOUND_REPRESENTATION_ITEM('',SET_REPRESENTATION_ITEM(({solids[0]})))")
    outer = s.add(f"COMPOUND_REPRESENTATION_ITEM('',LIST_REPRESENTATION_ITEM(({inner},{solids[1]})))")
    s.part([s.axes(), outer])
    s.write(path)


@case("two_shells", "one SHELL_BASED_SURFACE_MODEL of a closed and an open shell", solids=0, closed=False, faces=11)
def two_shells(path: Path) -> None:
    s = Step(path.stem)
    closed = s.add(f"CLOSED_SHELL('',{refs(block(s, (0, 0, 0), (5, 5, 5)))})")
    opened = s.add(f"OPEN_SHELL('',{refs(block(s, (10, 0, 0), (15, 5, 5), skip='top'))})")
    model = s.add(f"SHELL_BASED_SURFACE_MODEL('',({closed},{opened}))")
    s.part([s.axes(), model], "MANIFOLD_SURFACE_SHAPE_REPRESENTATION")
    s.write(path)


@case("face_based", "FACE_BASED_SURFACE_MODEL of a connected face set", solids=0, closed=False, faces=5)
def face_based(path: Path) -> None:
    s = Step(path.stem)
    faces = s.add(f"CONNECTED_FACE_SET('',{refs(block(s, O, (5, 6, 7), skip='top'))})")
    s.part([s.axes(), s.add(f"FACE_BASED_SURFACE_MODEL('',({faces}))")], "SHAPE_REPRESENTATION")
    s.write(path)


@case("voids_oriented", "BREP_WITH_VOIDS by hand: its void is an ORIENTED_CLOSED_SHELL", solids=1, closed=True,
      faces=12)
def voids_oriented(path: Path) -> None:
    s = Step(path.stem)
    outer = s.add(f"CLOSED_SHELL('',{refs(block(s, (-10, -10, -10), (10, 10, 10)))})")
    inner = s.add(f"CLOSED_SHELL('',{refs(block(s, (-4, -5, -6), (4, 5, 6)))})")
    void = s.add(f"ORIENTED_CLOSED_SHELL('',*,{inner},.F.)")
    s.part([s.axes(), s.add(f"BREP_WITH_VOIDS('',{outer},({void}))")])
    s.write(path)


@case("wires_and_points", "loose curves and points beside a solid: reported, not meshed", solids=1, closed=True,
      faces=6)
def wires_and_points(path: Path) -> None:
    s = Step(path.stem)
    solid = s.solid(block(s, O, (10, 10, 10)))
    circle = s.circle((0, 0, 20), Z, X, 5)
    arc = s.add(f"TRIMMED_CURVE('',{circle},(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(2.)),.T.,.PARAMETER.)")
    line = s.add(f"POLYLINE('',{refs([s.point((0, 0, 20 + k)) for k in range(3)])})")
    loose = s.add(f"GEOMETRIC_CURVE_SET('',{refs([arc, line, s.point((1, 2, 30)), s.point((2, 3, 30))])})")
    s.part([s.axes(), solid, loose])
    s.write(path)


@case("wireframe_only", "only curves and points: nothing to mesh", solids=0, closed=False, faces=0)
def wireframe_only(path: Path) -> None:
    s = Step(path.stem)
    items = [s.add(f"POLYLINE('',{refs([s.point((k, k * k, 0)) for k in range(5)])})"), s.point((1, 1, 1))]
    loose = s.add(f"GEOMETRIC_CURVE_SET('',{refs(items)})")
    s.part([s.axes(), loose], "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION", )
    s.write(path)


@case("ap203_by_hand", "an AP203 configuration controlled file by hand", solids=1, closed=True, faces=6)
def ap203_by_hand(path: Path) -> None:
    s = Step(path.stem, AP203)
    s.part([s.axes(), s.solid(block(s, O, (3, 4, 5)))])
    s.write(path)


def tetrahedron() -> tuple[list[Point], list[tuple[int, int, int]]]:
    return [O, (10, 0, 0), (0, 10, 0), (0, 0, 10)], [(1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4)]


@case("tessellated_solid", "AP242: a TESSELLATED_SOLID of TRIANGULATED_FACEs, nothing exact", solids=1, closed=True,
      faces=4)
def tessellated_solid(path: Path) -> None:
    s = Step(path.stem, AP242)
    points, triangles = tetrahedron()
    table = "(" + ",".join(numbers(p) for p in points) + ")"
    coordinates = s.add(f"COORDINATES_LIST('',{len(points)},{table})")
    faces = []
    for triangle in triangles:
        faces.append(s.add(f"TRIANGULATED_FACE('',{coordinates},3,(),$,{integers(triangle)},((1,2,3)))"))
    solid = s.add(f"TESSELLATED_SOLID('',{refs(faces)},$)")
    s.part([s.axes(), solid], "TESSELLATED_SHAPE_REPRESENTATION")
    s.write(path)


@case("tessellated_strips", "AP242: a COMPLEX_TRIANGULATED_SURFACE_SET of a strip and a fan with normals", solids=0,
      closed=False, faces=1)
def tessellated_strips(path: Path) -> None:
    s = Step(path.stem, AP242)
    strip = [(5.0 * (k // 2), 5.0 * (k % 2), math.sin(k // 2)) for k in range(10)]
    fan = [(40.0, 0.0, 0.0)] + [(40 + 6 * math.cos(0.5 * k), 6 * math.sin(0.5 * k), 0.0) for k in range(6)]
    points = [*strip, *fan]
    table = "(" + ",".join(numbers(p) for p in points) + ")"
    coordinates = s.add(f"COORDINATES_LIST('',{len(points)},{table})")
    indices = integers(range(1, len(points) + 1))
    strips, fans = integers(range(1, 11)), integers(range(11, 18))
    item = s.add(f"COMPLEX_TRIANGULATED_SURFACE_SET('',{coordinates},{len(points)},((0.,0.,1.)),{indices},"
                 f"({strips}),({fans}))")
    s.part([s.axes(), item], "TESSELLATED_SHAPE_REPRESENTATION")
    s.write(path)
