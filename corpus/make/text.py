"""The file as text: encodings, numbers, order, comments. The geometry is a small block with a round hole."""

from __future__ import annotations

import re
from pathlib import Path

from case import case
from loops import plate
from part21 import Step


def plain(name: str) -> str:
    s = Step(name)
    s.part([s.axes(), s.solid(plate(s, [0, 1, 2], 0), name)])
    return s.text()


@case("integers_as_reals", "integers where reals belong, reals as `1.E1`, `+2.` and `.5`-like forms", solids=1,
      closed=True, faces=8)
def integers_as_reals(path: Path) -> None:
    body = plain(path.stem)
    body = re.sub(r"(?<=[(,])(-?\d+)\.(?=[,)])", r"\1", body)
    body = body.replace("(20,10,", "(2.E1,+10.,").replace("(-20,10,", "(-2.0E+01,1.E+1,")
    path.write_text(body, encoding="ascii", newline="\n")


@case("strings", "names in every encoding: \\X2\\, \\X4\\, \\X\\, \\S\\, \\P, doubled quotes, raw UTF-8", solids=1,
      closed=True, faces=8)
def strings(path: Path) -> None:
    body = plain("NAME")
    odd = [r"it''s", r"caf\X\E9", r"\X2\03B103B2\X0\ beta", r"\X4\0001F600\X0\ face", r"\S\C\S\d", r"\PE\\S\P", "Größe",
           "a;b#3=c/*no comment*/", r"back\\slash"]
    names = iter(odd)
    body = re.sub(r"ADVANCED_FACE\(''", lambda m: f"ADVANCED_FACE('{next(names, '')}'", body)
    body = body.replace("'NAME'", r"'pi\X2\00E8\X0\ce \X2\90E854C1\X0\ ''1'''")
    path.write_text(body, encoding="utf-8", newline="\n")


@case("order_reversed", "entities in reverse order: every reference points forward", solids=1, closed=True, faces=8)
def order_reversed(path: Path) -> None:
    head, data = plain(path.stem).split("DATA;\n")
    lines, tail = data.split("ENDSEC;")
    text = head + "DATA;\n" + "\n".join(reversed(lines.strip().split("\n"))) + "\nENDSEC;" + tail
    path.write_text(text, encoding="ascii", newline="\n")


@case("layout", "comments, blank lines, tabs, CRLF, entities over many lines and many on one, ids with leading zeros",
      solids=1, closed=True, faces=8)
def layout(path: Path) -> None:
    lines = plain(path.stem).split("\n")
    out: list[str] = []
    for k, line in enumerate(lines):
        if not line.startswith("#"):
            out.append(line + "\r\n")
        elif k % 4 == 0:
            out.append(line.replace(",", " ,\r\n\t ").replace("=", " = /* why not; #7 */ ") + "\r\n\r\n")
        elif k % 4 == 1:
            out.append(line.replace("#", "#000"))
        else:
            out.append(line + ("" if k % 2 else "\r\n"))
    path.write_text("".join(out), encoding="ascii", newline="")


@case("sparse_ids", "ids up to 2^40, far apart", solids=1, closed=True, faces=8)
def sparse_ids(path: Path) -> None:
    text = re.sub(r"#(\d+)", lambda m: f"#{int(m[1]) * 1234567891 + 7}", plain(path.stem))
    path.write_text(text, encoding="ascii", newline="\n")


@case("sections", "two DATA sections and an ANCHOR section (edition 3)", solids=1, closed=True, faces=8)
def sections(path: Path) -> None:
    head, data = plain(path.stem).split("DATA;\n")
    lines = data.split("ENDSEC;")[0].strip().split("\n")
    half = len(lines) // 2
    text = (head.replace("'2;1'", "'4;1'") + "ANCHOR;\n<plate>=#1;\nENDSEC;\n"
            + "DATA('first',('AUTOMOTIVE_DESIGN'));\n" + "\n".join(lines[:half]) + "\nENDSEC;\n"
            + "DATA('second',('AUTOMOTIVE_DESIGN'));\n" + "\n".join(lines[half:]) + "\nENDSEC;\nEND-ISO-10303-21;\n")
    path.write_text(text, encoding="ascii", newline="\n")
