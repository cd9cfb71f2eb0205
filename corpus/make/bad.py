"""Broken files: one clear sentence and exit 2, or exit 1 with everything that can be saved; never a panic or
a hang."""

from __future__ import annotations

import re
from pathlib import Path

from case import bad_case
from loops import O, X, Z, band, block, plate
from part21 import Step
from text import plain


def save(path: Path, text: str) -> None:
    path.write_text(text, encoding="ascii", newline="\n")


def solid_of(s: Step, faces: list[str]) -> str:
    s.part([s.axes(), s.solid(faces)])
    return s.text()


@bad_case("empty", "a file of no bytes", exit="2", phrase="empty")
def empty(path: Path) -> None:
    save(path, "")


@bad_case("not_step", "not a STEP file at all", exit="2", phrase="triangle mesh (STL)")
def not_step(path: Path) -> None:
    save(path, "solid cube\n  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n" * 3)


@bad_case("binary", "binary noise", exit="2", phrase="ISO-10303-21")
def binary(path: Path) -> None:
    path.write_bytes(bytes((i * i * 31 + i * 7) % 256 for i in range(4096)))


@bad_case("header_only", "a header and nothing else", exit="2", phrase="DATA")
def header_only(path: Path) -> None:
    save(path, plain(path.stem).split("DATA;")[0])


@bad_case("no_shape", "entities, but no shape", exit="2", phrase="no shape")
def no_shape(path: Path) -> None:
    s = Step(path.stem)
    s.product("nothing")
    save(path, s.text())


@bad_case("truncated_tail", "cut off after the shell: the solid is missing, its faces can be saved", exit="0,1",
          phrase="truncated")
def truncated_tail(path: Path) -> None:
    text = plain(path.stem)
    save(path, text[:text.index("MANIFOLD_SOLID_BREP") + 12])


@bad_case("truncated_middle", "cut off in the middle of an entity, half of the faces are there", exit="0,1",
          phrase="truncated")
def truncated_middle(path: Path) -> None:
    text = plain(path.stem)
    cut = [m.start() for m in re.finditer("ADVANCED_FACE", text)][4]
    save(path, text[:cut + 20])


@bad_case("missing_semicolon", "three entities without their `;`", exit="0,1", phrase="")
def missing_semicolon(path: Path) -> None:
    lines = plain(path.stem).split("\n")
    for kind in ("CARTESIAN_POINT", "DIRECTION", "LINE("):
        k = [i for i, line in enumerate(lines) if kind in line][5]
        lines[k] = lines[k].rstrip(";")
    save(path, "\n".join(lines))


@bad_case("duplicate_ids", "one entity twice, the same; another twice, different", exit="0,1", phrase="#")
def duplicate_ids(path: Path) -> None:
    lines = plain(path.stem).split("\n")
    points = [i for i, line in enumerate(lines) if "CARTESIAN_POINT" in line]
    lines.insert(points[9] + 1, lines[points[9]])
    clash = lines[points[4]].split("=")[0] + "=CARTESIAN_POINT('',(999.,999.,999.));"
    lines.insert(lines.index("ENDSEC;", points[-1]), clash)
    save(path, "\n".join(lines))


@bad_case("missing_entity", "a face refers to a surface that is not in the file", exit="1", phrase="#")
def missing_entity(path: Path) -> None:
    text = plain(path.stem)
    first = re.search(r"#(\d+)=CYLINDRICAL_SURFACE.*?;\n", text)
    save(path, text.replace(first[0], ""))


@bad_case("missing_edge", "one oriented edge of a loop is not in the file", exit="1", phrase="1 of 4 edges could not be read")
def missing_edge(path: Path) -> None:
    text = plain(path.stem)
    loops = re.findall(r"=EDGE_LOOP\('',\(#\d+,(#\d+),#\d+,#\d+\)\)", text)
    lost = re.search(loops[0] + r"=ORIENTED_EDGE.*?;\n", text)
    save(path, text.replace(lost[0], ""))


@bad_case("cyclic_references", "a curve that is its own basis and an assembly within itself", exit="1,2", phrase="")
def cyclic_references(path: Path) -> None:
    s = Step(path.stem)
    faces = block(s, O, (10, 10, 10))
    n = len(s.lines)
    s.add(f"OFFSET_SURFACE('',#{n + 2},1.,.F.)")
    s.add(f"OFFSET_SURFACE('',#{n + 1},1.,.F.)")
    loop = s.polygon([(0, 0, 20), (5, 0, 20), (5, 5, 20)])
    faces.append(s.face([s.bound(loop, outer=True)], f"#{n + 1}"))
    part = s.part([s.axes(), s.solid(faces)])
    s.place(part, part, s.axes(), s.axes((1, 2, 3)), "myself")
    save(path, s.text())


@bad_case("huge_multiplicity", "a knot of multiplicity 2000000000", exit="1,2", phrase="#")
def huge_multiplicity(path: Path) -> None:
    s = Step(path.stem)
    net = [[(10 * i, 10 * j, i * j) for j in range(4)] for i in range(4)]
    surface = s.spline_surface((3, 3), net, ((0, 1), (2_000_000_000, 2_000_000_000)), ((0, 1), (4, 4)))
    loop = s.polygon([net[0][0], net[3][0], net[3][3], net[0][3]])
    save(path, solid_of(s, [*block(s, (50, 0, 0), (60, 10, 10)), s.face([s.bound(loop, outer=True)], surface)]))


@bad_case("huge_degree", "a B-spline of degree 2000000000", exit="1,2", phrase="#")
def huge_degree(path: Path) -> None:
    s = Step(path.stem)
    net = [[(10 * i, 10 * j, i * j) for j in range(4)] for i in range(4)]
    surface = s.spline_surface((2_000_000_000, 3), net, ((0, 1), (4, 4)), ((0, 1), (4, 4)))
    loop = s.polygon([net[0][0], net[3][0], net[3][3], net[0][3]])
    save(path, solid_of(s, [*block(s, (50, 0, 0), (60, 10, 10)), s.face([s.bound(loop, outer=True)], surface)]))


@bad_case("nan", "NaN for a coordinate", exit="1,2", phrase="#")
def nan(path: Path) -> None:
    save(path, plain(path.stem).replace("(20.,10.,5.)", "(NaN,10.,5.)"))


@bad_case("absurd_exponent", "a coordinate of 1.E999 and one of 1.E300", exit="1,2", phrase="#")
def absurd_exponent(path: Path) -> None:
    text = plain(path.stem)
    save(path, text.replace("(20.,10.,5.)", "(1.E999,10.,5.)").replace("(-20.,-10.,5.)", "(-1.E300,-10.,5.)"))


@bad_case("zero_radius", "a cylinder of radius 0 and a cone of half-angle 90 degrees", exit="1,2", phrase="#")
def zero_radius(path: Path) -> None:
    s = Step(path.stem)
    faces = block(s, O, (10, 10, 10))
    low, high = s.ring((20, 0, 0), Z, X, 3), s.ring((20, 0, 9), Z, X, 3)
    faces.append(band(s, s.elementary("CYLINDRICAL_SURFACE", (20, 0, 0), Z, X, 0), (low, True), (high, False)))
    faces.append(band(s, s.elementary("CONICAL_SURFACE", (20, 0, 0), Z, X, 3, 1.5707963267948966),
                      (low, True), (high, False)))
    save(path, solid_of(s, faces))


@bad_case("zero_direction", "an axis whose direction is (0, 0, 0) and one parallel to its reference", exit="0,1",
          phrase="#")
def zero_direction(path: Path) -> None:
    s = Step(path.stem)
    faces = plate(s, [0, 1, 2], 0)
    text = solid_of(s, faces)
    cylinders = [m[1] for m in re.finditer(r"CYLINDRICAL_SURFACE\('',(#\d+)", text)]
    for axis, body in zip(cylinders, ("(0.,0.,0.)", "(1.,0.,0.)")):
        z = re.search(rf"{axis}=AXIS2_PLACEMENT_3D\('',#\d+,(#\d+),", text)[1]
        text = re.sub(rf"\n{z}=DIRECTION\('',\(.*?\)\)", f"\n{z}=DIRECTION('',{body})", text)
    save(path, text)


@bad_case("wrong_types", "a face whose surface is a curve, a loop of points, a string for a number", exit="1",
          phrase="#")
def wrong_types(path: Path) -> None:
    s = Step(path.stem)
    faces = block(s, O, (10, 10, 10))
    ring = s.ring((0, 0, 20), Z, X, 3)
    circle = s.circle((0, 0, 20), Z, X, 3)
    faces.append(s.face([s.bound(s.loop([(ring, True)]), outer=True)], circle))
    faces.append(s.face([s.bound(s.point((1, 1, 1)), outer=True)], s.plane((0, 0, 20), Z, X)))
    broken = s.add(f"CYLINDRICAL_SURFACE('',{s.axes()},'three')")
    faces.append(s.face([s.bound(s.loop([(ring, True)]), outer=True)], broken))
    save(path, solid_of(s, faces))


@bad_case("too_few_arguments", "entities with arguments missing", exit="1", phrase="#")
def too_few_arguments(path: Path) -> None:
    s = Step(path.stem)
    faces = block(s, O, (10, 10, 10))
    ring = s.ring((0, 0, 20), Z, X, 3)
    short = s.add(f"CYLINDRICAL_SURFACE('',{s.axes()})")
    faces.append(s.face([s.bound(s.loop([(ring, True)]), outer=True)], short))
    faces.append(s.add("ADVANCED_FACE('')"))
    save(path, solid_of(s, faces))


@bad_case("open_loop", "a loop with one edge missing and a shell with one face missing", exit="1", phrase="#")
def open_loop(path: Path) -> None:
    s = Step(path.stem)
    faces = block(s, O, (10, 10, 10), skip="top")
    p, q, r = (30, 0, 0), (40, 0, 0), (40, 10, 0)
    loop = s.loop([s.segment(p, q), s.segment(q, r)])
    faces.append(s.face([s.bound(loop, outer=True)], s.plane(p, Z, X)))
    save(path, solid_of(s, faces))


@bad_case("crossing_loop", "a bow-tie: a planar loop that truly crosses itself", exit="0,1", phrase="")
def crossing_loop(path: Path) -> None:
    s = Step(path.stem)
    points = [(0, 0, 0), (10, 0, 0), (0, 10, 0), (12, 9, 0)]
    face = s.face([s.bound(s.polygon(points), outer=True)], s.plane(O, Z, X))
    s.part([s.axes(), s.sheet([face])], "MANIFOLD_SURFACE_SHAPE_REPRESENTATION")
    save(path, s.text())


@bad_case("knots_decreasing", "knots that run backwards and too few multiplicities", exit="1,2", phrase="#")
def knots_decreasing(path: Path) -> None:
    s = Step(path.stem)
    net = [[(10 * i, 10 * j, i * j) for j in range(4)] for i in range(4)]
    loop = s.polygon([net[0][0], net[3][0], net[3][3], net[0][3]])
    surfaces = [s.spline_surface((3, 3), net, ((1, 0), (4, 4)), ((0, 1), (4, 4))),
                s.spline_surface((3, 3), net, ((0, 1), (4, 2)), ((0, 1), (4, 4)))]
    faces = [s.face([s.bound(loop, outer=True)], surface) for surface in surfaces]
    save(path, solid_of(s, [*block(s, (50, 0, 0), (60, 10, 10)), *faces]))


@bad_case("deep_nesting", "brackets 70000 deep in an entity that nothing uses", exit="0,1,2", phrase="")
def deep_nesting(path: Path) -> None:
    s = Step(path.stem)
    s.part([s.axes(), s.solid(block(s, O, (1, 1, 1)))])
    s.add("DIRECTION(''," + "(" * 70_000 + "1." + ")" * 70_000 + ")")
    save(path, s.text())


@bad_case("long_chain", "a chain of 1000 mapped items", exit="0,1,2", phrase="")
def long_chain(path: Path) -> None:
    s = Step(path.stem)
    axes = s.axes()
    item = s.solid(block(s, O, (1, 1, 1)))
    for _ in range(1000):
        shape = s.add(f"SHAPE_REPRESENTATION('',({axes},{item}),{s.context})")
        item = s.add(f"MAPPED_ITEM('',{s.add(f'REPRESENTATION_MAP({axes},{shape})')},{axes})")
    s.part([axes, item], "SHAPE_REPRESENTATION")
    save(path, s.text())


@bad_case("mapped_bomb", "each of 40 levels places the one below twice: 2^40 instances", exit="1,2", phrase="")
def mapped_bomb(path: Path) -> None:
    s = Step(path.stem)
    axes, moved = s.axes(), s.axes((1, 2, 3))
    items = [s.solid(block(s, O, (1, 1, 1)))]
    for _ in range(40):
        shape = s.add(f"SHAPE_REPRESENTATION('',({axes},{','.join(items)}),{s.context})")
        source = s.add(f"REPRESENTATION_MAP({axes},{shape})")
        items = [s.add(f"MAPPED_ITEM('',{source},{target})") for target in (axes, moved)]
    s.part([axes, *items], "SHAPE_REPRESENTATION")
    save(path, s.text())
