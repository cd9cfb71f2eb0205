"""Writes BREP (OpenCASCADE text) by hand: tables of geometry, and shapes that use them by number."""

from __future__ import annotations

from dataclasses import dataclass, field


def numbers(*values: float) -> str:
    """Numbers and (nested) tuples of them, with blanks between."""
    flat: list[str] = []
    for value in values:
        if isinstance(value, (tuple, list)):
            flat.append(numbers(*value))
        else:
            flat.append(f"{value:.17g}")
    return " ".join(flat)


TITLES = {1: "V1, (c) Matra-Datavision", 2: "V2, (c) Matra-Datavision", 3: "V3, (c) Open Cascade"}


@dataclass
class Brep:
    """A file under construction. Every method that adds something returns its number; uses of shapes are
    `use(shape, "+")`."""

    version: int = 1
    locations: list[str] = field(default_factory=list)
    curves2: list[str] = field(default_factory=list)
    curves: list[str] = field(default_factory=list)
    surfaces: list[str] = field(default_factory=list)
    triangulations: list[str] = field(default_factory=list)
    shapes: list[tuple[str, str, str, list[tuple[str, int, int]]]] = field(default_factory=list)

    @staticmethod
    def _add(table: list[str], text: str) -> int:
        table.append(text)
        return len(table)

    def placement(self, rows: list[tuple[float, float, float, float]]) -> int:
        return self._add(self.locations, "1\n" + "\n".join(numbers(*row) for row in rows))

    def moved(self, x: float, y: float, z: float) -> int:
        return self.placement([(1, 0, 0, x), (0, 1, 0, y), (0, 0, 1, z)])

    def product(self, *factors: tuple[int, int]) -> int:
        return self._add(self.locations, "2  " + " ".join(f"{n} {power}" for n, power in factors) + " 0")

    def curve2(self, kind: int, *values: float, tail: str = "") -> int:
        return self._add(self.curves2, f"{kind} {numbers(*values)}{tail}")

    def curve(self, kind: int, *values: float, tail: str = "") -> int:
        return self._add(self.curves, f"{kind} {numbers(*values)}{tail}")

    def surface(self, kind: int, *values: float, tail: str = "") -> int:
        return self._add(self.surfaces, f"{kind} {numbers(*values)}{tail}")

    def triangulation(self, points: list, triangles: list, normals: list | None = None) -> int:
        flags = "0" + (f" {1 if normals else 0}" if self.version == 3 else "")
        head = f"{len(points)} {len(triangles)} {flags} 0.1"
        body = [numbers(*points), numbers(*triangles)] + ([numbers(*normals)] if normals else [])
        return self._add(self.triangulations, head + "\n" + " ".join(body))

    def shape(self, kind: str, geometry: str, flags: str, uses: list[tuple[str, int, int]]) -> int:
        self.shapes.append((kind, geometry, flags, uses))
        return len(self.shapes)

    def vertex(self, point: tuple[float, float, float], tolerance: float = 1e-7) -> int:
        return self.shape("Ve", f"{tolerance}\n{numbers(*point)}\n0 0\n", "0101101", [])

    def edge(self, ends: tuple[int, int], curve: int | None, span: tuple[float, float], pcurves: str = "",
             degenerated: bool = False) -> int:
        geometry = f" 1e-07 1 1 {int(degenerated)}\n"
        if curve:
            geometry += f"1  {curve} 0 {numbers(*span)}\n"
        uses = [("+", ends[0], 0), ("-", ends[1], 0)]
        return self.shape("Ed", geometry + pcurves + "0\n", "0101000", uses)

    def pcurve(self, number: int, surface: int, span: tuple[float, float], ends: tuple = (0, 0, 0, 0)) -> str:
        """A curve on a surface; `ends` are the (u, v) of its ends, which only version 2 has."""
        tail = f"\n{numbers(*ends)}" if self.version == 2 else ""
        return f"2  {number} {surface} 0 {numbers(*span)}{tail}\n"

    def seam(self, forward: int, backward: int, surface: int, span: tuple[float, float]) -> str:
        tail = "\n0 0 0 0" if self.version == 2 else ""
        return f"3  {forward} {backward}CN {surface} 0 {numbers(*span)}{tail}\n"

    def wire(self, *uses: tuple[str, int, int]) -> int:
        return self.shape("Wi", "", "0101100", list(uses))

    def face(self, surface: int, *wires: int, triangulation: int = 0) -> int:
        geometry = f"0  1e-07 {surface} 0\n" + (f"2  {triangulation}\n" if triangulation else "")
        return self.shape("Fa", geometry, "0101000", [("+", w, 0) for w in wires])

    def shell(self, *uses: tuple[str, int, int], closed: bool = True) -> int:
        return self.shape("Sh", "", f"0101{int(closed)}00", list(uses))

    def solid(self, shell: int) -> int:
        return self.shape("So", "", "1100000", [("+", shell, 0)])

    def compound(self, *uses: tuple[str, int, int]) -> int:
        return self.shape("Co", "", "1100000", list(uses))

    def text(self, root: int, location: int = 0, orientation: str = "+") -> str:
        count = len(self.shapes)

        def use(sign: str, shape: int, location: int) -> str:
            return f"{sign}{count - shape + 1} {location}"

        def section(name: str, items: list[str]) -> str:
            return "\n".join([f"{name} {len(items)}", *items])

        body = [
            section("Locations", self.locations), section("Curve2ds", self.curves2), section("Curves", self.curves),
            "Polygon3D 0", "PolygonOnTriangulations 0", section("Surfaces", self.surfaces),
            section("Triangulations", self.triangulations), "", f"TShapes {count}",
        ]
        for kind, geometry, flags, uses in self.shapes:
            body.append(f"{kind}\n{geometry}\n{flags}\n" + " ".join([*(use(*u) for u in uses), "*"]))
        title = f"DBRep_DrawableShape\n\nCASCADE Topology {TITLES[self.version]}\n"
        return title + "\n".join(body) + f"\n\n{use(orientation, root, location)} 0\n"
