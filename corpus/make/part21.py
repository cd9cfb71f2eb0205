"""A Part 21 file put together by hand: for what a CAD kernel cannot or will not write."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

Point = Sequence[float]
Use = tuple[str, bool]  # an edge and whether it is used in its own direction

AP203 = "CONFIG_CONTROL_DESIGN"
AP214 = "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }"
AP242 = "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }"


def real(x: float) -> str:
    """A number as Part 21 wants it: with a point, exponent in capitals."""
    text = repr(float(x)).upper()
    if "." not in text:
        text = text.replace("E", ".E") if "E" in text else text + "."
    return text[:-1] if text.endswith(".0") else text


def numbers(values: Sequence[float]) -> str:
    return "(" + ",".join(real(v) for v in values) + ")"


def refs(ids: Sequence[str]) -> str:
    return "(" + ",".join(ids) + ")"


def integers(values: Sequence[int]) -> str:
    return "(" + ",".join(str(v) for v in values) + ")"


def flag(value: bool) -> str:
    return ".T." if value else ".F."


class Step:
    """Collects entities; every method that makes one returns its `#id`."""

    def __init__(self, name: str, schema: str = AP214, uncertainty: float = 1e-7, unit: str = "mm") -> None:
        self.name, self.schema = name, schema
        self.lines: list[str] = []
        self._vertices: dict[tuple[float, ...], str] = {}
        self._segments: dict[tuple[str, str], str] = {}
        self.uncertainty = uncertainty
        self._application: str | None = None
        self.context = self.new_context(unit)

    # -- the file

    def add(self, body: str) -> str:
        self.lines.append(body)
        return f"#{len(self.lines)}"

    def text(self) -> str:
        head = (f"ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('{self.name}'),'2;1');\n"
                f"FILE_NAME('{self.name}','2026-01-01T00:00:00',(''),(''),'','','');\n"
                f"FILE_SCHEMA(('{self.schema}'));\nENDSEC;\nDATA;\n")
        data = "".join(f"#{i}={body};\n" for i, body in enumerate(self.lines, 1))
        return head + data + "ENDSEC;\nEND-ISO-10303-21;\n"

    def write(self, path: Path) -> None:
        path.write_text(self.text(), encoding="ascii", newline="\n")

    # -- units and products

    def new_context(self, unit: str = "mm", degrees: bool = False) -> str:
        """A representation context in mm, m or inch; angles in radians or degrees."""
        length = self._length_unit(unit)
        angle = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
        if degrees:
            one = self.add(f"PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE({real(math.pi / 180)}),{angle})")
            exponents = self.add("DIMENSIONAL_EXPONENTS(0.,0.,0.,0.,0.,0.,0.)")
            angle = self.add(f"(CONVERSION_BASED_UNIT('DEGREE',{one})NAMED_UNIT({exponents})PLANE_ANGLE_UNIT())")
        solid = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
        accuracy = self.add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({real(self.uncertainty)}),{length},"
                            "'distance_accuracy_value','')")
        return self.add(f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({accuracy}))"
                        f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid}))REPRESENTATION_CONTEXT('',''))")

    def _length_unit(self, unit: str) -> str:
        if unit == "m":
            return self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))")
        millimetre = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
        if unit == "mm":
            return millimetre
        one = self.add(f"LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),{millimetre})")
        exponents = self.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)")
        return self.add(f"(CONVERSION_BASED_UNIT('INCH',{one})LENGTH_UNIT()NAMED_UNIT({exponents}))")

    def part(self, items: Sequence[str], kind: str = "ADVANCED_BREP_SHAPE_REPRESENTATION", name: str | None = None,
             context: str | None = None) -> tuple[str, str]:
        """A product with one representation; returns (product definition, representation)."""
        name = name if name is not None else self.name
        representation = self.add(f"{kind}('{name}',{refs(items)},{context or self.context})")
        definition = self.product(name)
        shape = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION({shape},{representation})")
        return definition, representation

    def product(self, name: str) -> str:
        if self._application is None:
            self._application = self.add("APPLICATION_CONTEXT('mechanical design')")
        product_context = self.add(f"PRODUCT_CONTEXT('',{self._application},'mechanical')")
        product = self.add(f"PRODUCT('{name}','{name}','',({product_context}))")
        formation = self.add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
        design = self.add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{self._application},'design')")
        return self.add(f"PRODUCT_DEFINITION('design','',{formation},{design})")

    def place(self, parent: tuple[str, str], child: tuple[str, str], origin: str, target: str, name: str) -> None:
        """Puts `child` into `parent`: `origin` (in the child) goes to `target` (in the parent)."""
        usage = self.add(f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{name}','{name}','',{parent[0]},{child[0]},$)")
        shape = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{usage})")
        moved = self.add(f"ITEM_DEFINED_TRANSFORMATION('','',{origin},{target})")
        relation = self.add(f"(REPRESENTATION_RELATIONSHIP('','',{child[1]},{parent[1]})"
                            f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION({moved})"
                            "SHAPE_REPRESENTATION_RELATIONSHIP())")
        self.add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION({relation},{shape})")

    # -- geometry

    def point(self, p: Point) -> str:
        return self.add(f"CARTESIAN_POINT('',{numbers(p)})")

    def direction(self, d: Point) -> str:
        return self.add(f"DIRECTION('',{numbers(d)})")

    def axes(self, origin: Point = (0, 0, 0), z: Point = (0, 0, 1), x: Point = (1, 0, 0)) -> str:
        return self.add(f"AXIS2_PLACEMENT_3D('',{self.point(origin)},{self.direction(z)},{self.direction(x)})")

    def axis(self, origin: Point = (0, 0, 0), z: Point = (0, 0, 1)) -> str:
        return self.add(f"AXIS1_PLACEMENT('',{self.point(origin)},{self.direction(z)})")

    def line(self, p: Point, q: Point) -> str:
        d = [b - a for a, b in zip(p, q)]
        length = math.sqrt(sum(c * c for c in d))
        vector = self.add(f"VECTOR('',{self.direction([c / length for c in d])},{real(length)})")
        return self.add(f"LINE('',{self.point(p)},{vector})")

    def circle(self, origin: Point, z: Point, x: Point, radius: float) -> str:
        return self.add(f"CIRCLE('',{self.axes(origin, z, x)},{real(radius)})")

    def elementary(self, kind: str, origin: Point, z: Point, x: Point, *values: float) -> str:
        """PLANE, CYLINDRICAL_SURFACE, CONICAL_SURFACE, SPHERICAL_SURFACE, TOROIDAL_SURFACE."""
        tail = "".join("," + real(v) for v in values)
        return self.add(f"{kind}('',{self.axes(origin, z, x)}{tail})")

    def plane(self, origin: Point, z: Point, x: Point) -> str:
        return self.elementary("PLANE", origin, z, x)

    def spline(self, degree: int, points: Sequence[Point], knots: Sequence[float], mults: Sequence[int],
               weights: Sequence[float] | None = None, closed: bool = False) -> str:
        """A B-spline curve, rational where weights are given."""
        control = refs([self.point(p) for p in points])
        core = f"{degree},{control},.UNSPECIFIED.,{flag(closed)},.F."
        ends = f"{integers(mults)},{numbers(knots)},.UNSPECIFIED."
        if weights is None:
            return self.add(f"B_SPLINE_CURVE_WITH_KNOTS('',{core},{ends})")
        return self.add(f"(BOUNDED_CURVE()B_SPLINE_CURVE({core})B_SPLINE_CURVE_WITH_KNOTS({ends})CURVE()"
                        f"GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE({numbers(weights)})"
                        "REPRESENTATION_ITEM(''))")

    def spline_surface(self, degrees: tuple[int, int], net: Sequence[Sequence[Point]], u: Knots, v: Knots,
                       weights: Sequence[Sequence[float]] | None = None,
                       closed: tuple[bool, bool] = (False, False)) -> str:
        """A B-spline surface; `net[i][j]`: i runs with u. `u`, `v`: (knots, multiplicities)."""
        control = "(" + ",".join(refs([self.point(p) for p in row]) for row in net) + ")"
        core = f"{degrees[0]},{degrees[1]},{control},.UNSPECIFIED.,{flag(closed[0])},{flag(closed[1])},.F."
        ends = f"{integers(u[1])},{integers(v[1])},{numbers(u[0])},{numbers(v[0])},.UNSPECIFIED."
        if weights is None:
            return self.add(f"B_SPLINE_SURFACE_WITH_KNOTS('',{core},{ends})")
        table = "(" + ",".join(numbers(row) for row in weights) + ")"
        return self.add(f"(BOUNDED_SURFACE()B_SPLINE_SURFACE({core})B_SPLINE_SURFACE_WITH_KNOTS({ends})"
                        f"GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE({table})REPRESENTATION_ITEM('')"
                        "SURFACE())")

    # -- topology

    def vertex(self, p: Point) -> str:
        key = tuple(float(c) + 0.0 for c in p)
        if key not in self._vertices:
            self._vertices[key] = self.add(f"VERTEX_POINT('',{self.point(p)})")
        return self._vertices[key]

    def edge(self, p: Point, q: Point, curve: str, sense: bool = True) -> str:
        return self.add(f"EDGE_CURVE('',{self.vertex(p)},{self.vertex(q)},{curve},{flag(sense)})")

    def segment(self, p: Point, q: Point) -> Use:
        """The one straight edge between two points, and its direction."""
        a, b = self.vertex(p), self.vertex(q)
        if (b, a) in self._segments:
            return self._segments[b, a], False
        if (a, b) not in self._segments:
            self._segments[a, b] = self.edge(p, q, self.line(p, q))
        return self._segments[a, b], True

    def ring(self, origin: Point, z: Point, x: Point, radius: float) -> str:
        """A whole circle as one edge with one vertex."""
        start = [o + radius * c for o, c in zip(origin, x)]
        return self.edge(start, start, self.circle(origin, z, x, radius))

    def loop(self, uses: Sequence[Use]) -> str:
        return self.add("EDGE_LOOP(''," + refs([self.add(f"ORIENTED_EDGE('',*,*,{e},{flag(s)})") for e, s in uses])
                        + ")")

    def polygon(self, points: Sequence[Point]) -> str:
        return self.loop([self.segment(p, q) for p, q in zip(points, [*points[1:], points[0]])])

    def bound(self, loop: str, outer: bool = False, orientation: bool = True) -> str:
        return self.add(f"FACE_{'OUTER_' if outer else ''}BOUND('',{loop},{flag(orientation)})")

    def face(self, bounds: Sequence[str], surface: str, sense: bool = True, name: str = "") -> str:
        return self.add(f"ADVANCED_FACE('{name}',{refs(bounds)},{surface},{flag(sense)})")

    def disc(self, ring: str, use: bool, origin: Point, z: Point, x: Point) -> str:
        """A planar face within one closed edge."""
        return self.face([self.bound(self.loop([(ring, use)]), outer=True)], self.plane(origin, z, x))

    def flat(self, *loops: Sequence[Point]) -> str:
        """A planar face from polygons; the first gives the normal by its sense."""
        normal = newell(loops[0])
        x = unit([b - a for a, b in zip(loops[0][0], loops[0][1])])
        bounds = [self.bound(self.polygon(points), outer=i == 0) for i, points in enumerate(loops)]
        return self.face(bounds, self.plane(loops[0][0], normal, x))

    def solid(self, faces: Sequence[str], name: str = "") -> str:
        return self.add(f"MANIFOLD_SOLID_BREP('{name}',{self.add(f'CLOSED_SHELL({chr(39)*2},{refs(faces)})')})")

    def sheet(self, faces: Sequence[str], closed: bool = False) -> str:
        """A surface model of one shell."""
        shell = self.add(f"{'CLOSED' if closed else 'OPEN'}_SHELL('',{refs(faces)})")
        return self.add(f"SHELL_BASED_SURFACE_MODEL('',({shell}))")


Knots = tuple[Sequence[float], Sequence[int]]


def write_solid(step: Step, faces: Sequence[str], path: Path) -> None:
    step.part([step.axes(), step.solid(faces, step.name)])
    step.write(path)


def write_sheet(step: Step, faces: Sequence[str], path: Path) -> None:
    step.part([step.axes(), step.sheet(faces)], "MANIFOLD_SURFACE_SHAPE_REPRESENTATION")
    step.write(path)


def unit(v: Point) -> list[float]:
    length = math.sqrt(sum(c * c for c in v))
    return [c / length for c in v]


def cross(a: Point, b: Point) -> list[float]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def newell(points: Sequence[Point]) -> list[float]:
    """The unit normal of a polygon."""
    total = [0.0, 0.0, 0.0]
    for p, q in zip(points, [*points[1:], points[0]]):
        total = [t + c for t, c in zip(total, cross(p, q))]
    return [c + 0.0 for c in unit(total)]
