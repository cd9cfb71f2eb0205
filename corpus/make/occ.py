"""Writing and reading STEP through OpenCASCADE, such that the same script writes the same bytes."""

from __future__ import annotations

import os
import re
from pathlib import Path

from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.Message import Message
from OCP.STEPCAFControl import STEPCAFControl_Reader, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDF import TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

Message.DefaultMessenger_s().Printers().Clear()

SCHEMAS = {"AP203": "AP203", "AP214": "AP214IS", "AP242": "AP242DIS"}


def write_shape(shape: TopoDS_Shape, path: Path, schema: str = "AP214", pcurves: bool = True) -> None:
    """Writes one shape as a single part, in millimetres."""
    writer = STEPControl_Writer()
    _settings(schema, pcurves)
    if writer.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone:
        raise RuntimeError(f"transfer failed: {path}")
    writer.Write(str(path))
    normalise(path)


def write_document(doc: TDocStd_Document, path: Path, schema: str = "AP214") -> None:
    """Writes an assembly with its names and colours."""
    writer = STEPCAFControl_Writer()
    _settings(schema, False)
    writer.SetColorMode(True)
    writer.SetNameMode(True)
    if not writer.Transfer(doc, STEPControl_AsIs):
        raise RuntimeError(f"transfer failed: {path}")
    writer.Write(str(path))
    normalise(path)


def _settings(schema: str, pcurves: bool) -> None:
    Interface_Static.SetCVal_s("write.step.schema", SCHEMAS[schema])
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    Interface_Static.SetIVal_s("write.surfacecurve.mode", int(pcurves))


def normalise(path: Path) -> None:
    """Replaces what differs from run to run (the date) and what names the writing machine."""
    text = path.read_text(encoding="latin-1")
    text = re.sub(r"FILE_NAME\(.*?\);", f"FILE_NAME('{path.stem}','2026-01-01T00:00:00',(''),(''),'','','');",
                  text, count=1, flags=re.S)
    text = re.sub(r"Open CASCADE STEP translator [\d.]+ [\d.]+", path.stem, text)
    text = re.sub(r"LOCAL_TIME\(\d+,\d+,", "LOCAL_TIME(0,0,", text)
    text = re.sub(r"CALENDAR_DATE\(\d+,\d+,\d+\)", "CALENDAR_DATE(2026,1,1)", text)
    path.write_text(text, encoding="latin-1", newline="\n")


def count(path: Path) -> tuple[int, int, bool] | None:
    """Faces (instances counted), solids and validity as OpenCASCADE sees the file; None where it reads
    nothing."""
    doc = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    reader = STEPCAFControl_Reader()
    if reader.ReadFile(os.fspath(path)) != IFSelect_RetDone or not reader.Transfer(doc):
        return None
    labels = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(doc.Main()).GetFreeShapes(labels)
    faces = solids = 0
    valid = True
    for i in range(1, labels.Length() + 1):
        shape = XCAFDoc_ShapeTool.GetShape_s(labels.Value(i))
        faces += _count(shape, TopAbs_FACE)
        solids += _count(shape, TopAbs_SOLID)
        valid = valid and BRepCheck_Analyzer(shape).IsValid()
    return faces, solids, valid


def _count(shape: TopoDS_Shape, kind) -> int:
    explorer, n = TopExp_Explorer(shape, kind), 0
    while explorer.More():
        n += 1
        explorer.Next()
    return n
