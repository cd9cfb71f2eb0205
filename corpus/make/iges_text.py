"""Writes IGES (fixed ASCII) by hand: entities with their directory entries and parameters."""

from __future__ import annotations

from dataclasses import dataclass, field


def number(value: float | int | str) -> str:
    if isinstance(value, str):
        return f"{len(value)}H{value}"
    if isinstance(value, int):
        return str(value)
    text = repr(float(value))
    return text.replace("e", "E") if "e" in text else text


@dataclass
class Entity:
    kind: int
    values: list
    form: int
    matrix: int
    color: int
    level: int
    status: str
    label: str


@dataclass
class Iges:
    """A file under construction. `add` returns the number of an entity; nested tuples and lists of values are
    flattened."""

    unit: tuple[int, str] = (2, "MM")
    scale: float = 1.0
    product: str = ""
    delimiters: str = ",;"
    entities: list[Entity] = field(default_factory=list)

    def add(self, kind: int, *values, form: int = 0, matrix: int = 0, color: int = 0, level: int = 0,
            status: str = "00000000", label: str = "") -> int:
        flat: list = []

        def flatten(value) -> None:
            if isinstance(value, (tuple, list)):
                for v in value:
                    flatten(v)
            else:
                flat.append(value)

        flatten(values)
        self.entities.append(Entity(kind, flat, form, matrix, color, level, status, label))
        return 2 * len(self.entities) - 1

    def line(self, a: tuple, b: tuple, status: str = "00010000") -> int:
        return self.add(110, (*a, 0.0)[:3], (*b, 0.0)[:3], status=status)

    def chain(self, points: list[tuple], status: str = "00010000") -> int:
        """A closed composite curve of lines."""
        n = len(points)
        parts = [self.line(points[i], points[(i + 1) % n], status) for i in range(n)]
        return self.add(102, len(parts), parts, status=status)

    def circle(self, center: tuple, radius: float, height: float = 0.0, status: str = "00010000", matrix: int = 0) -> int:
        x, y = center
        return self.add(100, height, x, y, x + radius, y, x + radius, y, status=status, matrix=matrix)

    def bilinear(self, p00: tuple, p10: tuple, p01: tuple, p11: tuple, ranges: tuple = (0.0, 1.0, 0.0, 1.0),
                 **more) -> int:
        """A plane or twisted patch over 0..1 in both parameters."""
        knots = (0.0, 0.0, 1.0, 1.0)
        return self.add(128, 1, 1, 1, 1, 0, 0, 1, 0, 0, knots, knots, 1.0, 1.0, 1.0, 1.0, p00, p10, p01, p11, ranges,
                        **more)

    def trimmed(self, surface: int, *boundaries: int, **more) -> int:
        outer, *inner = boundaries
        return self.add(144, surface, 1, len(inner), outer, inner, **more)

    def boundary(self, surface: int, parameters: int, model: int, preference: int = 0) -> int:
        return self.add(142, 0, surface, parameters, model, preference, status="00010000")

    def text(self, width: int = 64) -> str:
        comma, end = self.delimiters
        strings = [number(comma), number(end)]
        head = [self.product, "by hand.igs", "by hand", "by hand", 32, 38, 6, 308, 15, self.product, float(self.scale),
                self.unit[0], self.unit[1], 1, 0.01, "20260101.000000", 1e-6, 100.0, "nobody", "nowhere", 11, 0]
        body = comma.join([*strings, *(number(v) if v != "" else "" for v in head)]) + end
        lines = [f"{'Written by hand.':<72}S{1:>7}"]
        lines += [f"{body[i:i + 72]:<72}G{i // 72 + 1:>7}" for i in range(0, len(body), 72)]
        directory, parameters = [], []
        for k, e in enumerate(self.entities):
            first = len(parameters) + 1
            text = ""
            for i, value in enumerate([e.kind, *e.values]):
                piece = number(value) + (end if i == len(e.values) else comma)
                if len(text) + len(piece) > width:
                    parameters.append((text, 2 * k + 1))
                    text = ""
                text += piece
            parameters.append((text, 2 * k + 1))
            count = len(parameters) + 1 - first
            directory.append(f"{e.kind:>8}{first:>8}{0:>8}{0:>8}{e.level:>8}{0:>8}{e.matrix:>8}{0:>8}{e.status:>8}")
            directory.append(f"{e.kind:>8}{0:>8}{e.color:>8}{count:>8}{e.form:>8}{'':>16}{e.label:>8}{0:>8}")
        lines += [f"{text}D{i + 1:>7}" for i, text in enumerate(directory)]
        lines += [f"{text:<64}{owner:>8}P{i + 1:>7}" for i, (text, owner) in enumerate(parameters)]
        counts = [1, sum(line[72] == "G" for line in lines), len(directory), len(parameters)]
        lines.append(f"{''.join(f'{s}{n:>7}' for s, n in zip('SGDP', counts)):<72}T{1:>7}")
        return "\n".join(lines) + "\n"
