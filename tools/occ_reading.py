"""Reads a STEP file with OpenCASCADE and says which entity of the file each of its faces came from."""

from __future__ import annotations

import os
import re
from pathlib import Path

from OCP.IFSelect import IFSelect_RetDone
from OCP.Message import Message
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDF import TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Builder, TopoDS_Compound, TopoDS_Face, TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

Message.DefaultMessenger_s().Printers().Clear()

to_face = getattr(TopoDS, "Face_s", None) or TopoDS.Face


class StepFile:
    """One file, read once. `shape` is everything that is placed at the top."""

    def __init__(self, path: Path | str) -> None:
        self.path = path
        self.doc = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
        self.reader = STEPCAFControl_Reader()
        if self.reader.ReadFile(os.fspath(path)) != IFSelect_RetDone:
            raise ValueError(f"OpenCASCADE cannot read {path}")
        self.reader.Transfer(self.doc)
        self.shape = _free_shapes(self.doc)

    def faces(self) -> list[TopoDS_Face]:
        """Every instance, in the explorer's order."""
        return explore_faces(self.shape)

    def entity_of_face(self) -> list[str | None]:
        """`#123` for every face of `faces`, None where the origin is not known."""
        session = self.reader.ChangeReader().WS()
        model, transfer = session.Model(), session.TransferReader()
        # The binding's maps from entities do not work; the identity of the wrapped objects does while they
        # are held.
        entities = [model.Value(i) for i in range(1, model.NbEntities() + 1)]
        ids = entity_ids(self.path)
        if len(ids) != len(entities):
            return [None] * len(self.faces())
        id_of = {id(entity): name for entity, name in zip(entities, ids)}
        known: dict[int, str | None] = {}
        names = []
        for face in self.faces():
            shape = face.Located(TopLoc_Location())
            key = hash(shape)
            if key not in known:
                known[key] = id_of.get(id(transfer.EntityFromShapeResult(shape, 1)))
            names.append(known[key])
        return names


def entity_ids(path: Path | str) -> list[str]:
    """The ids of the data section in the file's order, which is the order of OpenCASCADE's model."""
    text = Path(path).read_bytes().decode("latin-1")
    data = text[text.find("DATA;") :]
    bare = re.sub(r"'(?:[^']|'')*'|/\*.*?\*/", "''", data, flags=re.S)
    return [f"#{int(n)}" for n in re.findall(r"#(\d+)\s*=", bare)]


def explore_faces(shape: TopoDS_Shape) -> list[TopoDS_Face]:
    explorer, faces = TopExp_Explorer(shape, TopAbs_FACE), []
    while explorer.More():
        faces.append(to_face(explorer.Current()))
        explorer.Next()
    return faces


def _free_shapes(doc: TDocStd_Document) -> TopoDS_Compound:
    labels = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(doc.Main()).GetFreeShapes(labels)
    builder, compound = TopoDS_Builder(), TopoDS_Compound()
    builder.MakeCompound(compound)
    for i in range(1, labels.Length() + 1):
        builder.Add(compound, XCAFDoc_ShapeTool.GetShape_s(labels.Value(i)))
    return compound
