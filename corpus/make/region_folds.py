"""Faces without area, edges that fold, edges of no length."""

from __future__ import annotations

import math
import random
from pathlib import Path

from part21 import Step, write_sheet, write_solid
from rings import Model, turned


def sliver(rng: random.Random | None) -> Model:
    """A box of which one vertical edge is given twice, with a face between the two that has no area."""
    a, b, c = [rng.uniform(2, 30) for _ in range(3)] if rng else (20.0, 12.0, 8.0)
    off = (10 ** rng.uniform(-9, -5) * c) if rng else 2e-6
    loose = rng.randrange(2) if rng else 0

    def write(path: Path) -> None:
        s = Step(path.stem, uncertainty=1e-5)
        f = turned(rng)
        at = f.at
        low = [at(0, 0, 0), at(a, 0, 0), at(a, b, 0), at(0, b, 0)]
        high = [at(0, 0, c), at(a, 0, c), at(a, b, c), at(0, b, c)]
        p, q = low[1], high[1]
        # The same two vertices; the second curve leaves them by a little.
        if loose:
            second = s.edge(p, q, s.line(at(a + off, 0, 0), at(a + off, 0, c)))
        else:
            middle = at(a + off, -off, c / 2)
            second = s.edge(p, q, s.spline(2, [p, middle, q], [0, 1], [3, 3]))
        first, _ = s.segment(p, q)
        side = [s.flat([low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]]) for i in (0, 2, 3)]
        right = s.loop(
            [
                s.segment(low[1], low[2]),
                s.segment(low[2], high[2]),
                s.segment(high[2], high[1]),
                (second, False),
            ]
        )
        side.append(s.face([s.bound(right, outer=True)], s.plane(low[1], f.x, f.y)))
        normal = f.along(math.sqrt(0.5), -math.sqrt(0.5), 0)
        thin = s.loop([(first, False), (second, True)])
        side.append(s.face([s.bound(thin, outer=True)], s.plane(p, normal, f.z)))
        write_solid(s, [*side, s.flat(low[::-1]), s.flat(high)], path)

    return "", 2 * (a * b + b * c + c * a), write


def folded_edge(rng: random.Random | None) -> Model:
    """A plate with a slit of no width: one closed edge, there and back, and a cylinder's face in it."""
    a, b = [rng.uniform(5, 30) for _ in range(2)] if rng else (20.0, 12.0)
    r = min(a, b) * 0.2

    def write(path: Path) -> None:
        s = Step(path.stem)
        f = turned(rng)
        p, q = f.at(a / 2, b / 2, 0), f.at(a / 2 + r, b / 2, 0)
        there_and_back = s.edge(p, p, s.spline(1, [p, q, p], [0, 0.5, 1], [2, 1, 2]))
        corners = [f.at(0, 0, 0), f.at(a, 0, 0), f.at(a, b, 0), f.at(0, b, 0)]
        plate = s.face(
            [s.bound(s.polygon(corners), outer=True), s.bound(s.loop([(there_and_back, False)]))],
            s.plane(f.o, f.z, f.x),
        )
        tube = s.elementary("CYLINDRICAL_SURFACE", f.at(a / 2, b / 2, -r), f.x, f.z, r)
        inside = s.face([s.bound(s.loop([(there_and_back, True)]), outer=True)], tube)
        write_sheet(s, [plate, inside], path)

    return "", a * b, write


def no_length(rng: random.Random | None) -> Model:
    """A plate with an edge of no length and one that runs back over its neighbour."""
    a, b = [rng.uniform(5, 30) for _ in range(2)] if rng else (20.0, 12.0)

    def write(path: Path) -> None:
        s = Step(path.stem, uncertainty=1e-5)
        f = turned(rng)
        o, x, xy, y = f.at(0, 0, 0), f.at(a, 0, 0), f.at(a, b, 0), f.at(0, b, 0)
        tip = f.at(a, 1.5 * b, 0)
        again = s.add(f"VERTEX_POINT('',{s.point(tip)})")
        nothing = s.add(
            f"EDGE_CURVE('',{s.vertex(tip)},{again},{s.line(tip, f.at(a - 2e-6, 1.5 * b, 0))},.T.)"
        )
        back = s.add(f"EDGE_CURVE('',{again},{s.vertex(xy)},{s.line(tip, xy)},.T.)")
        uses = [
            s.segment(o, x),
            s.segment(x, tip),
            (nothing, True),
            (back, True),
            s.segment(xy, y),
            s.segment(y, o),
        ]
        write_sheet(s, [s.face([s.bound(s.loop(uses), outer=True)], s.plane(f.o, f.z, f.x))], path)

    return "", a * b, write
