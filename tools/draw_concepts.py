#!/usr/bin/env python3
"""Draws the pictures of docs/concepts.md as SVG files. Needs Python only.

tools/draw_concepts.py [-o docs/pictures]
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

Point = tuple[float, float]

EXACT, MESH, MARK, FILL, TEXT = "#0072b2", "#d55e00", "#555555", "#e8eef4", "#222222"


class Drawing:
    """Shapes in pixels, y downwards, on a white ground so that they show on dark pages too."""

    def __init__(self, width: int, height: int) -> None:
        self.size = (width, height)
        self.shapes: list[str] = []

    def line(
        self, points: Iterable[Point], color: str, width: float = 2, fill: str = "none", dash: str = ""
    ) -> None:
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        self.shapes.append(
            f'<polyline points="{path}" fill="{fill}" stroke="{color}" stroke-width="{width}"'
            f' stroke-linejoin="round"{dashed}/>'
        )

    def dots(self, points: Iterable[Point], color: str, radius: float = 3.5) -> None:
        self.shapes += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{color}"/>' for x, y in points]

    def text(self, at: Point, words: str, color: str = TEXT, anchor: str = "start") -> None:
        self.shapes.append(
            f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" fill="{color}" text-anchor="{anchor}">{words}</text>'
        )

    def arrow(self, start: Point, end: Point) -> None:
        """A line with a head at both ends: a distance."""
        self.shapes.append(
            f'<line x1="{start[0]:.1f}" y1="{start[1]:.1f}" x2="{end[0]:.1f}" y2="{end[1]:.1f}"'
            f' stroke="{MARK}" stroke-width="1.3" marker-start="url(#head)" marker-end="url(#head)"/>'
        )

    def write(self, path: Path) -> None:
        width, height = self.size
        head = (
            '<marker id="head" orient="auto-start-reverse" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7"'
            f' markerHeight="7"><path d="M0 0 L8 4 L0 8 z" fill="{MARK}"/></marker>'
        )
        path.write_text(
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}"'
            f' height="{height}" font-family="sans-serif" font-size="13">\n<defs>{head}</defs>\n'
            f'<rect width="{width}" height="{height}" fill="white"/>\n'
            + "\n".join(self.shapes)
            + "\n</svg>\n",
            encoding="utf-8",
        )


def curve(of: Callable[[float], Point], start: float, end: float, steps: int = 80) -> list[Point]:
    return [of(start + (end - start) * i / steps) for i in range(steps + 1)]


def chordal_error() -> Drawing:
    """A surface in section, its facets, and the tolerance band that holds both."""
    drawing = Drawing(640, 250)
    centre, radius = (320, 420), 330

    def on(angle: float, r: float = radius) -> Point:
        return centre[0] + r * math.sin(angle), centre[1] - r * math.cos(angle)

    ends, band = 0.85, 26
    outer = curve(lambda a: on(a, radius + band), -ends, ends)
    inner = curve(lambda a: on(a, radius - band), ends, -ends)
    drawing.line([*outer, *inner, outer[0]], FILL, 1, FILL)
    drawing.line(curve(on, -ends, ends), EXACT, 2.5)
    vertices = [on(-ends + 2 * ends * i / 3) for i in range(4)]
    drawing.line(vertices, MESH, 2.5)
    drawing.dots(vertices, MESH)
    middle = ((vertices[1][0] + vertices[2][0]) / 2, (vertices[1][1] + vertices[2][1]) / 2)
    drawing.arrow(on(0), middle)
    drawing.text((330, 113), "error")
    drawing.arrow(on(0.62), on(0.62, radius + band))
    drawing.text((on(0.62, radius + band)[0] + 8, on(0.62, radius + band)[1] - 4), "tolerance")
    drawing.text((20, 30), "exact surface", EXACT)
    drawing.text((20, 50), "mesh", MESH)
    drawing.text((20, 70), "within tolerance of the surface", MARK)
    return drawing


def gap() -> Drawing:
    """Two faces whose common edge, as the file gives it, lies on neither."""
    drawing = Drawing(640, 240)
    left = curve(lambda t: (60 + 240 * t, 60 + 90 * t * t), 0, 1)
    right = curve(lambda t: (340 + 240 * t, 150 - 80 * t + 20 * t * t), 0, 1)
    drawing.line(left, EXACT, 2.5)
    drawing.line(right, EXACT, 2.5)
    edge = (320, 118)
    drawing.line([left[0], left[40], edge], MESH, 2.5)
    drawing.line([edge, right[45], right[-1]], MESH, 2.5)
    drawing.dots([left[0], left[40], edge, right[45], right[-1]], MESH)
    drawing.arrow(edge, left[-1])
    drawing.arrow(edge, right[0])
    drawing.text((320, 182), "gap: the edge of the file lies off both surfaces", anchor="middle")
    drawing.text(
        (320, 204), "the mesh stays closed, because both faces use the vertex on the edge", MARK, "middle"
    )
    drawing.text((80, 45), "face 1", EXACT)
    drawing.text((530, 75), "face 2", EXACT)
    drawing.text((320, 100), "edge of the file", MESH, "middle")
    return drawing


def shells() -> Drawing:
    """Closed, open by design, leaking: three boxes in projection."""
    drawing = Drawing(640, 230)
    for index, (title, reason) in enumerate(
        (
            ("closed", "every edge has two triangles"),
            ("open by design", "the file holds a sheet"),
            ("leaking", "a face of a solid failed"),
        )
    ):
        x = 110 + 210 * index
        top = [(x - 60, 60), (x + 20, 40), (x + 70, 70), (x - 10, 92)]
        front = [top[0], top[3], (x - 10, 172), (x - 60, 138)]
        side = [top[3], top[2], (x + 70, 148), (x - 10, 172)]
        if title == "open by design":
            drawing.line([*top, top[0]], EXACT, 2, FILL)
            drawing.line([top[0], top[2]], MARK, 1)
            drawing.line([*top, top[0]], MESH, 2.5)
        else:
            for face in (top, front, side):
                missing = title == "leaking" and face is side
                drawing.line([*face, face[0]], EXACT, 1.5, "#ffffff" if missing else FILL)
                if not missing:
                    drawing.line([face[0], face[2]], MARK, 1)
            if title == "leaking":
                drawing.line([*side, side[0]], MESH, 2.5)
        drawing.text((x, 200), title, anchor="middle")
        drawing.text((x, 219), reason, MARK, "middle")
    drawing.text((10, 18), "edges with one triangle", MESH)
    return drawing


def trimmed_face() -> Drawing:
    """Loops in the parameter plane, and the same face in space."""
    drawing = Drawing(640, 260)
    drawing.line([(30, 50), (280, 50), (280, 220), (30, 220), (30, 50)], MARK, 1, dash="4 4")
    outer = [(50, 80), (200, 65), (262, 120), (235, 205), (70, 200), (50, 80)]
    drawing.line(outer, EXACT, 2.5, FILL)
    hole = curve(lambda a: (150 + 36 * math.cos(a), 138 + 30 * math.sin(a)), 0, 2 * math.pi)
    drawing.line(hole, EXACT, 2.5, "#ffffff")
    drawing.text((36, 40), "parameter plane (u, v)")
    drawing.text((36, 238), "dashed: domain of the surface", MARK)
    drawing.text((150, 143), "hole", MARK, "middle")

    def lift(point: Point) -> Point:
        u, v = (point[0] - 30) / 250, (point[1] - 50) / 170
        return 350 + 230 * u + 30 * v, 95 + 120 * v - 60 * math.sin(math.pi * u)

    def lifted(points: list[Point]) -> list[Point]:
        dense = [
            (a[0] + (b[0] - a[0]) * i / 20, a[1] + (b[1] - a[1]) * i / 20)
            for a, b in zip(points, points[1:])
            for i in range(21)
        ]
        return [lift(p) for p in dense]

    drawing.line(lifted([(30, 50), (280, 50), (280, 220), (30, 220), (30, 50)]), MARK, 1, dash="4 4")
    drawing.line(lifted(outer), EXACT, 2.5, FILL)
    drawing.line(lifted(hole), EXACT, 2.5, "#ffffff")
    drawing.dots([lift(p) for p in outer[:-1]], MESH)
    drawing.text((630, 22), "the face in space: surface within its loops", anchor="end")
    drawing.text((470, 250), "edges, shared with the neighbouring faces", MARK, "middle")
    return drawing


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "-o", "--output", type=Path, default=Path(__file__).resolve().parent.parent / "docs" / "pictures"
    )
    folder = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    for draw in (chordal_error, gap, shells, trimmed_face):
        draw().write(folder / f"{draw.__name__}.svg")
    return 0


if __name__ == "__main__":
    sys.exit(main())
