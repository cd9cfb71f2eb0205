"""Every snippet of the documentation runs, in one folder, in the order of the page."""

from __future__ import annotations

import re
import shutil
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
PAGES = [ROOT / "docs" / "python.md", ROOT / "apps" / "python" / "README.md"]
# Packages that a snippet may need, by the words that show it.
NEEDS = {"to_trimesh": "trimesh", "to_pyvista": "pyvista", "to_open3d": "open3d", "to_meshio": "meshio"}
NEEDS |= {"OCP": "OCP", "geomdl": "geomdl", "networkx": "networkx", "rhino3dm": "rhino3dm"}


def snippets() -> list[object]:
    found: list[object] = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        for match in re.finditer(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
            line = text.count("\n", 0, match.start()) + 1
            found.append(pytest.param(match.group(1), id=f"{page.name}:{line}"))
    return found


def test_there_are_snippets() -> None:
    assert len(snippets()) > 10


@pytest.mark.parametrize("code", snippets())
def test_a_snippet_runs(code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for word, package in NEEDS.items():
        if word in code and find_spec(package) is None:
            pytest.skip(f"{package} is not installed")
    corpus = ROOT / "corpus"
    for name in ["bracket.step", "styles.step", "mapped_items.step"]:
        shutil.copy(corpus / name, tmp_path)
    shutil.copy(corpus / "exchange" / "rhino_solids_8.3dm", tmp_path / "part.3dm")
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "snippet", "exec"), {"__name__": "__main__"})
