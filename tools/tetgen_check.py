#!/usr/bin/env python3
"""Fills every closed shell of meshes of models with tetrahedra by TetGen, and lists those it cannot fill.

    tools/tetgen_check.py MODEL [MODEL ...] [--binary PROGRAM] [--tolerance 0.1%,0.01%]

TetGen (`pip install tetgen`) needs a boundary without holes and without triangles that cut each other. Each
component of a mesh whose sides pair up in opposite directions is filled by itself; components that are only
other placements of one part are filled once. Open components are counted and not filled.

TetGen refuses two facets that meet at less than 0.1 degrees, and takes four points for coplanar within 1e-8 of
the size: what fails is tried again with 0.0001 degrees and 1e-12. The exit status is 1 where a component is not
filled even so, although the program reports no crossing of triangles for its model.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

from arguments import add_binary, parser_of

# Seconds that TetGen may take for one component.
TIME_LIMIT = 300

# TetGen as it is, and with smaller angles and distances that it takes for zero.
SWITCHES = ("pQ", "p//0.0001QT1e-12")


def main() -> None:
    parser = parser_of(__doc__)
    parser.add_argument("models", metavar="MODEL", nargs="+")
    add_binary(parser)
    parser.add_argument("--tolerance", default="0.1%,0.01%", help="tolerances, separated by commas")
    parser.add_argument("--component", metavar="SWITCHES", help="fill one component from an .npz file")
    args = parser.parse_args()
    if args.component:
        fill(args.models[0], args.component)
        return
    failed = 0
    print("model\ttolerance\texit\tclosed\topen\tfilled\tby smaller limits\tcrossing pairs reported\tnot filled")
    for model in args.models:
        for tolerance in args.tolerance.split(","):
            row = check(args.binary.absolute(), model, tolerance)
            failed += row.pop()
            print("\t".join(map(str, [Path(model).name, tolerance, *row])), flush=True)
    sys.exit(1 if failed else 0)


def check(binary: Path, model: str, tolerance: str) -> list:
    """One row of the table, and the number of components that should be filled and are not."""
    with tempfile.TemporaryDirectory() as folder:
        mesh, report = Path(folder, "mesh.ply"), Path(folder, "report.json")
        command = [binary, "mesh", model, "-o", mesh, "--report", report, "--tolerance", tolerance, "--quiet"]
        status = subprocess.run(command, capture_output=True).returncode
        if status > 1 or not mesh.exists():
            return [status, 0, 0, 0, 0, 0, "no mesh", 0]
        parts = json.loads(report.read_text())["parts"]
        crossing = sum(c["triangle_pairs"] for part in parts for c in part["self_intersections"])
        closed, opened = components(mesh)
        failed = [c for c in closed if filled(c, folder, SWITCHES[0])]
        reasons = [reason for c in failed if (reason := filled(c, folder, SWITCHES[1]))]
    unexpected = len(reasons) if crossing == 0 else 0
    by_limits = [len(closed) - len(failed), len(failed) - len(reasons)]
    return [status, len(closed), opened, *by_limits, crossing, "; ".join(reasons), unexpected]


def components(path: Path) -> tuple[list, int]:
    """The closed components of a mesh as (vertices, triangles), each shape once, and how many are open."""
    import numpy as np

    vertices, triangles = read_ply(path)
    root = np.arange(len(vertices))
    while True:
        least = root.copy()
        for i, j in ((0, 1), (1, 2), (2, 0)):
            np.minimum.at(least, triangles[:, i], root[triangles[:, j]])
            np.minimum.at(least, triangles[:, j], root[triangles[:, i]])
        least = least[least]
        if (least == root).all():
            break
        root = least
    of_triangle = root[triangles[:, 0]]
    order = np.argsort(of_triangle, kind="stable")
    starts = np.flatnonzero(np.diff(of_triangle[order], prepend=-1))
    closed, opened, seen = [], 0, set()
    for group in np.split(order, starts[1:]):
        used, faces = np.unique(triangles[group], return_inverse=True)
        faces = faces.reshape(-1, 3)
        points = vertices[used]
        if not is_closed(faces):
            opened += 1
            continue
        sides = np.linalg.norm(points[faces[:, 0]] - points[faces[:, 1]], axis=1)
        shape = (len(points), len(faces), float(f"{sides.sum():.6g}"), float(f"{sides.max():.6g}"))
        if shape not in seen:
            seen.add(shape)
            closed.append((points, faces))
    return closed, opened


def is_closed(faces) -> bool:
    """True where every side occurs as often in one direction as in the other."""
    import numpy as np

    there = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).astype(np.int64)
    size = int(faces.max()) + 1
    one = np.sort(there[:, 0] * size + there[:, 1])
    back = np.sort(there[:, 1] * size + there[:, 0])
    return bool((one == back).all())


def read_ply(path: Path):
    """Vertices and triangles of a binary PLY file of this program."""
    import numpy as np

    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    types = {"double": "<f8", "float": "<f4", "int": "<i4", "uint": "<u4", "uchar": "u1", "char": "i1"}
    elements: list[tuple[str, int, list]] = []
    for line in data[:end].decode("utf-8", "replace").splitlines():
        words = line.split()
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property" and words[1] == "list":
            elements[-1][2].extend([("count", types[words[2]]), (words[4], types[words[3]], 3)])
        elif words[0] == "property":
            elements[-1][2].append((words[2], types[words[1]]))
    found = {}
    for name, count, fields in elements:
        found[name] = np.frombuffer(data, dtype=np.dtype(fields), count=count, offset=end)
        end += found[name].nbytes
    vertex, face = found["vertex"], found["face"]
    assert (face["count"] == 3).all(), "triangles only"
    points = np.stack([vertex["x"], vertex["y"], vertex["z"]], axis=1).astype(float)
    return points, face["vertex_indices"].astype(np.int64)


def filled(component, folder: str, switches: str) -> str:
    """Why TetGen cannot fill a component; nothing where it can. TetGen runs in a process of its own, because it
    may crash."""
    import numpy as np

    path = Path(folder, "component.npz")
    np.savez(path, points=component[0], faces=component[1])
    command = [sys.executable, __file__, "--component", switches, str(path)]
    size = f"{len(component[1])} triangles"
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIME_LIMIT)
    except subprocess.TimeoutExpired:
        return f"{size}: over {TIME_LIMIT} s"
    if done.returncode == 0:
        return ""
    lines = [line.strip() for line in done.stderr.splitlines() if line.strip()]
    return f"{size}: {lines[-1] if lines else f'status {done.returncode}'}"


def fill(path: str, switches: str) -> None:
    import numpy as np
    import tetgen

    data = np.load(path)
    tetgen.TetGen(data["points"], data["faces"].astype(np.int32)).tetrahedralize(switches=switches)


if __name__ == "__main__":
    main()
