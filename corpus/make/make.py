"""Writes the whole corpus, or the cases named, and the two INDEX.tsv files.

    python corpus/make/make.py [NAME ...]
"""

from __future__ import annotations

import argparse
import ast
import importlib
import subprocess
import sys
import traceback
from pathlib import Path

from case import BAD_CASES, CASES, Case

CORPUS = Path(__file__).resolve().parent.parent
MODULES = ["solids", "assemblies", "loops", "surfaces", "topology", "text", "bad"]
MAX_BYTES = 150_000


def main(names: list[str]) -> int:
    for module in MODULES:
        if (Path(__file__).parent / f"{module}.py").exists():
            importlib.import_module(module)
    failures = [c.name for c in CASES if _wanted(c.name, names) and not _write(c, CORPUS)]
    failures += [c.name for c in BAD_CASES if _wanted(c.name, names) and not _write(c, CORPUS / "bad")]
    _index()
    _bad_index()
    total = sum(f.stat().st_size for f in CORPUS.rglob("*.step"))
    print(f"{len(CASES)} files, {len(BAD_CASES)} broken ones, {total / 1e6:.2f} MB; failed: {failures or 'none'}")
    return 1 if failures else 0


def _wanted(name: str, names: list[str]) -> bool:
    return not names or name in names


def _write(case, folder: Path) -> bool:
    folder.mkdir(exist_ok=True)
    path = folder / f"{case.name}.step"
    try:
        case.write(path)
    except Exception:
        traceback.print_exc()
        return False
    if path.stat().st_size > MAX_BYTES:
        print(f"{case.name}: {path.stat().st_size} bytes, too large")
    return True


def _index() -> None:
    rows = ["name\ttests\tfaces\tsolids\tclosed\tocc_faces\tocc_solids\tocc_valid\tmade_by"]
    for c in CASES:
        path = CORPUS / f"{c.name}.step"
        if path.exists():
            rows.append("\t".join(map(str, _row(c, path))))
    (CORPUS / "INDEX.tsv").write_text("\n".join(rows) + "\n")


def _row(c: Case, path: Path) -> list[object]:
    faces, solids, valid = _seen_by_occ(path)
    declared = faces if c.faces is None else c.faces
    if (declared, c.solids) != (faces, solids):
        print(f"{c.name}: declared {declared} faces, {c.solids} solids; OpenCASCADE sees {faces} and {solids}")
    if not valid:
        print(f"{c.name}: OpenCASCADE calls it invalid")
    closed = "yes" if c.closed else "no"
    return [c.name, c.tests, declared, c.solids, closed, faces, solids, "yes" if valid else "no", c.made_by]


def _seen_by_occ(path: Path) -> tuple[int, int, bool]:
    """Counted in a process of its own: some of these files crash OpenCASCADE."""
    here = Path(__file__).parent
    code = "import sys; from pathlib import Path; from occ import count; print(count(Path(sys.argv[1])))"
    done = subprocess.run([sys.executable, "-c", code, str(path)], cwd=here, capture_output=True, text=True)
    if done.returncode != 0:
        print(f"{path.stem}: OpenCASCADE crashed")
    last = done.stdout.strip().split("\n")[-1]
    return ast.literal_eval(last) if last.startswith("(") else (0, 0, False)


def _bad_index() -> None:
    rows = ["name\ttests\texit\tphrase\tmade_by"]
    rows += [f"{c.name}\t{c.tests}\t{c.exit}\t{c.phrase}\t{c.made_by}" for c in BAD_CASES]
    (CORPUS / "bad").mkdir(exist_ok=True)
    (CORPUS / "bad" / "INDEX.tsv").write_text("\n".join(rows) + "\n")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="cases to write [default: all, and both indices]")
    sys.exit(main(parser.parse_args().names))
