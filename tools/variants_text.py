"""Rotated, mirrored and scaled variants of a STEP file, made on its text so that nothing else in it changes.

- rotated: every 3D point and direction is turned. Placements turn with the rest: R·T·R⁻¹ places a turned
  part.
- mirrored: every representation with a shape is wrapped in a mapped item with a mirroring operator; the
  placements T of an assembly become S·T·S, which is a rigid motion again.
- metres: the unit is a thousand times larger, the numbers stay.
- thousand: the numbers are a thousand times larger, the unit stays; only for files without pcurves, whose
  lengths hide among angles.
"""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

TURN_AXIS, TURN_ANGLE = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0), 0.7
SCALE = 1000.0

NUMBER = r"[-+]?[\d.]+(?:[eE][-+]?\d+)?"
TRIPLE = rf"\(\s*({NUMBER})\s*,\s*({NUMBER})\s*,\s*({NUMBER})\s*\)"
STRING = r"'(?:[^']|'')*'"

# Entities with lengths after the placement: how many of the numbers that follow are lengths.
LENGTHS = {
    "CIRCLE": 1,
    "ELLIPSE": 2,
    "HYPERBOLA": 2,
    "PARABOLA": 1,
    "CYLINDRICAL_SURFACE": 1,
    "CONICAL_SURFACE": 1,
    "SPHERICAL_SURFACE": 1,
    "TOROIDAL_SURFACE": 2,
    "DEGENERATE_TOROIDAL_SURFACE": 2,
    "OFFSET_SURFACE": 1,
    "VECTOR": 1,
}


def real(x: float) -> str:
    text = repr(float(x) + 0.0).upper()
    return text if "." in text else text.replace("E", ".E") if "E" in text else text + "."


def triple(values: np.ndarray) -> str:
    return "(" + ",".join(real(v) for v in values) + ")"


def rotation() -> np.ndarray:
    """About a skew axis, so that nothing stays aligned."""
    x, y, z = TURN_AXIS
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(TURN_ANGLE) * k + (1 - np.cos(TURN_ANGLE)) * k @ k


def map_triples(text: str, entity: str, change: Callable[[np.ndarray], np.ndarray]) -> str:
    """Changes the 3D coordinates of every `entity`; 2D ones, of pcurves, have two numbers and stay."""
    pattern = rf"({entity}\s*\(\s*{STRING}\s*,\s*){TRIPLE}"
    return re.sub(pattern, lambda m: m[1] + triple(change(np.array([float(m[i]) for i in (2, 3, 4)]))), text)


def map_lists(text: str, change: Callable[[np.ndarray], np.ndarray]) -> str:
    """The coordinates of tessellated items."""
    each = lambda m: triple(change(np.array([float(m[i]) for i in (1, 2, 3)])))
    return re.sub(
        r"COORDINATES_LIST\s*\(.*?\)\s*\)\s*\)", lambda m: re.sub(TRIPLE, each, m[0]), text, flags=re.S
    )


def rotated(text: str) -> str:
    turn = rotation()
    for entity in ("CARTESIAN_POINT", "DIRECTION"):
        text = map_triples(text, entity, lambda v: turn @ v)
    return map_lists(text, lambda v: turn @ v)


def metres(text: str) -> str:
    marked = re.sub(r"SI_UNIT\s*\(\s*\$\s*,\s*\.METRE\.\s*\)", "SI_UNIT(.KILO.,.METRE.)", text)
    return re.sub(r"SI_UNIT\s*\(\s*\.MILLI\.\s*,\s*\.METRE\.\s*\)", "SI_UNIT($,.METRE.)", marked)


def thousand(text: str) -> str | None:
    if re.search(r"PCURVE|RECTANGULAR_TRIMMED", text):
        return None
    text = map_triples(text, "CARTESIAN_POINT", lambda v: SCALE * v)
    text = map_lists(text, lambda v: SCALE * v)
    for entity, count in LENGTHS.items():
        pattern = rf"(\b{entity}\s*\(\s*{STRING}\s*,\s*#\d+)" + rf"\s*,\s*({NUMBER})" * count
        scaled = lambda m: m[1] + "".join("," + real(SCALE * float(v)) for v in m.groups()[1:])
        text = re.sub(pattern, scaled, text)
    return text


def mirrored(text: str) -> str:
    """In the plane x = 0."""
    ids = [int(n) for n in re.findall(r"#(\d+)\s*=", text)]
    writer = Appender(max(ids))
    shapes = set(re.findall(r"SHAPE_DEFINITION_REPRESENTATION\s*\(\s*#\d+\s*,\s*#(\d+)\s*\)", text))
    wrapped = {
        old: writer.wrap(old, context)
        for old in sorted(shapes, key=int)
        if (context := _context_of(text, old))
    }
    swap = lambda m: re.sub(r"#(\d+)", lambda n: f"#{wrapped.get(n[1], n[1])}", m[0])
    text = re.sub(r"SHAPE_DEFINITION_REPRESENTATION\s*\([^;]*;", swap, text)
    text = re.sub(r"\bREPRESENTATION_RELATIONSHIP\s*\([^)]*\)", swap, text)
    frames = lambda m: m[1] + ",".join("#" + str(writer.mirror_frame(text, n)) for n in (m[2], m[3])) + ")"
    text = re.sub(
        rf"(ITEM_DEFINED_TRANSFORMATION\s*\(\s*{STRING}\s*,\s*{STRING}\s*,\s*)#(\d+)\s*,\s*#(\d+)\s*\)",
        frames,
        text,
    )
    end = text.rindex("ENDSEC;")
    return text[:end] + "\n".join(writer.lines) + "\n" + text[end:]


def _entity(text: str, number: str) -> str:
    found = re.search(rf"#0*{number}\s*=\s*([^;]*);", text)
    if found is None:
        raise ValueError(f"#{number} is not in the file")
    return found[1]


def _context_of(text: str, representation: str) -> str | None:
    """The context of a representation that holds a shape; None where it only holds places."""
    body = _entity(text, representation)
    items = re.findall(r"#(\d+)", body)
    shapeless = all(re.match(r"AXIS2_PLACEMENT_3D", _entity(text, i)) for i in items[:-1])
    return None if shapeless else items[-1]


class Appender:
    """New entities at the end of the file."""

    def __init__(self, last: int) -> None:
        self.last, self.lines = last, []

    def add(self, body: str) -> int:
        self.last += 1
        self.lines.append(f"#{self.last}={body};")
        return self.last

    def point(self, values: np.ndarray) -> int:
        return self.add(f"CARTESIAN_POINT('',{triple(values)})")

    def direction(self, values: np.ndarray) -> int:
        return self.add(f"DIRECTION('',{triple(values)})")

    def frame(self, origin: np.ndarray, z: np.ndarray, x: np.ndarray) -> int:
        return self.add(
            f"AXIS2_PLACEMENT_3D('',#{self.point(origin)},#{self.direction(z)},#{self.direction(x)})"
        )

    def wrap(self, representation: str, context: str) -> int:
        """A representation that holds the mirror image of another."""
        e = np.eye(3)
        axes = self.frame(np.zeros(3), e[2], e[0])
        source = self.add(f"REPRESENTATION_MAP(#{axes},#{representation})")
        mirror = self.add(
            f"CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',#{self.direction(-e[0])},"
            f"#{self.direction(e[1])},#{self.point(np.zeros(3))},1.,#{self.direction(e[2])})"
        )
        item = self.add(f"MAPPED_ITEM('',#{source},#{mirror})")
        return self.add(f"SHAPE_REPRESENTATION('',(#{axes},#{item}),#{context})")

    def mirror_frame(self, text: str, placement: str) -> int:
        """S·A·S of a placement A."""
        origin, z, x = (_triple_of(text, n) for n in re.findall(r"#(\d+)", _entity(text, placement)))
        s = np.array([-1.0, 1.0, 1.0])
        return self.frame(s * origin, s * z, -s * x)


def _triple_of(text: str, number: str) -> np.ndarray:
    return np.array([float(v) for v in re.search(TRIPLE, _entity(text, number)).groups()])


VARIANTS: dict[str, tuple[Callable[[str], str | None], float]] = {
    "rotated": (rotated, 1.0),
    "mirrored": (mirrored, 1.0),
    "metres": (metres, SCALE),
    "thousand": (thousand, SCALE),
}
