#!/usr/bin/env python3
"""Files that are not STEP: what sewing made of them, and how far the meshes are from the surfaces of another
kernel.

    tools/measure_exchange.py MODELS --verify VERIFIER.py [--binary PROGRAM] [--only NAME …] [--out TABLE.md]

MODELS holds one folder per format (iges, brep, iv, x3d, obj, json, 3dm). Each file is meshed at 0.1 % of its
diagonal with `--sew auto`. The reference is never our own reader's. OpenCASCADE reads IGES and BREP, and the
verifier (`--verify` of `measure_models.py`) samples both directions. `exchange_surfaces.py` reads scenes,
OBJ, JSON and, with rhino3dm, 3DM anew, and OpenCASCADE evaluates: samples of the surfaces within their trims
to the mesh, and corners, middles of edges and centroids of the mesh to the trimmed surfaces. Of 3DM archives
trims are not to be had: the mesh is measured to the whole surfaces, and points along the archive's edges to
the mesh.

*measured* is compared with tolerance + gap, the gap being the larger of our report's and of the other
kernel's (its edges off its surfaces; sewing's largest move is within ours).
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from arguments import add_binary, add_models, add_verifier, parser_of

FOLDERS = ["iges", "brep", "iv", "x3d", "obj", "json", "3dm"]
SKIPPED = {".txt", ".md", ".tsv"}
ROUNDING = 1e-9
TIMEOUT = 480
# Places on one surface, and seconds, for looking again.
FINE = 90000
PATIENCE = 240
# Places near a point from which all that look too far are projected again.
PLACES = 6
# Sides from which a pole is left.
SIDES = 97
# Places on all surfaces from which the nearest point is looked for.
SEEDS = 48000


def child(verifier: str, path: Path, mesh: str, report: Path) -> dict:
    import numpy as np
    from measuring import load_verifier

    verify = load_verifier(verifier)
    told = json.loads(report.read_text())
    if path.parent.name not in ("iges", "brep"):
        return measure_patches(verify, path, mesh, told["options"]["tolerance"])
    shape = read_shape(path)
    verify.load_step = lambda _: (shape, None)
    reference = verify.Reference(str(path), 60000)
    points, faces = verify.load_mesh(mesh)
    result = verify.verify(reference, points, faces, told["options"]["tolerance"] + told["max_edge_gap"], 40000)
    gap = max(reference.edge_gap, 0.0)
    return {
        "to_mesh": result["s2m"]["max"],
        "to_surface": result["m2s"]["max"],
        "gap": gap,
        "diagonal": reference.diag,
        "faces": len(reference.faces),
        "worst": result["s2m"]["worst_point"],
        "worst2": result["m2s"]["worst_point"],
        "area": result["area_rel_err"],
        "missing": result["faces"]["missing"],
        "size": float(np.abs(points).max()),
    }


def read_shape(path: Path):
    from OCP.BRep import BRep_Builder
    from OCP.BRepTools import BRepTools
    from OCP.IGESControl import IGESControl_Reader
    from OCP.TopoDS import TopoDS_Shape

    if path.parent.name == "iges":
        reader = IGESControl_Reader()
        reader.ReadFile(str(path))
        reader.TransferRoots()
        return reader.OneShape()
    if path.parent.name == "brep":
        shape = TopoDS_Shape()
        BRepTools.Read_s(shape, str(path), BRep_Builder())
        return shape
    raise ValueError(path.parent.name)


def measure_patches(verify, path: Path, mesh: str, tolerance: float) -> dict:
    import exchange_surfaces as exchange
    import numpy as np
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
    from scipy.spatial import cKDTree

    rhino = path.parent.name == "3dm"
    patches, edges = exchange.rhino(path) if rhino else (exchange.READERS[path.parent.name](path), [])
    points, triangles = verify.load_mesh(mesh)
    distance = verify.MeshDist(points, triangles)
    corners = points[triangles]
    probes = np.concatenate([points, corners.mean(1), corners[:, [0, 1]].mean(1), corners[:, [1, 2]].mean(1)])
    rng = np.random.default_rng(1)
    if len(probes) > 15000:
        probes = probes[rng.choice(len(probes), 15000, replace=False)]
    diagonal = float(np.linalg.norm(points.max(0) - points.min(0)))
    best = np.full(len(probes), np.inf)
    samples, bodies = list(edges), []
    for patch in patches:
        face = verify.FaceRef(verify.TD(BRepBuilderAPI_MakeFace(exchange.surface(patch), 1e-9).Face()))
        face.ax = None
        face.uv = (
            face.ad.FirstUParameter(),
            face.ad.LastUParameter(),
            face.ad.FirstVParameter(),
            face.ad.LastVParameter(),
        )
        low, high = np.array(face.uv[::2]), np.array(face.uv[1::2])
        loops = tuple([exchange.sampled(loop) for loop in part] for part in (patch.outer, patch.holes))
        rims = [part for role in loops for loop in role for part in rim(face, loop, low, high)]
        # Where a trim runs along the surface's own border, what it cuts away ends there and nothing begins.
        inner = [loop[((loop > low) & (loop < high)).all(1)] for role in loops for loop in role]
        samples += [face.d0(part) for part in inner if len(part)]
        if not rhino:
            uv = np.concatenate([low + (high - low) * rng.random((6000, 2)), grid(face, patch)])
            # On the border itself nobody can say which side of a trim a point is on.
            uv = np.clip(uv, low + 1e-6 * (high - low), high - 1e-6 * (high - low))
            samples.append(face.d0(uv[exchange.inside(patch, loops, uv)]))
        # Far from its net no point is nearest to a patch.
        net = patch.net[..., :3]
        away = np.linalg.norm(
            np.maximum(0, np.maximum(net.min((0, 1)) - probes, probes - net.max((0, 1)))), axis=1
        )
        near = np.flatnonzero(away < np.minimum(best, diagonal))
        if not len(near):
            continue
        seeds = grid(face, patch, SEEDS // min(len(patches), 16))
        _, first = cKDTree(face.d0(seeds)).query(probes[near], k=2)
        border = Polylines(rims) if rims else None
        bodies.append([face, patch, loops, border, net.min((0, 1)), net.max((0, 1)), None])
        for k in range(2):
            todo = near[best[near] > 1e-9 * diagonal]
            uv, d = face.project(probes[todo], seeds[first[np.isin(near, todo), k]])
            if border is not None:
                out = ~exchange.inside(patch, loops, uv)
                d[out] = border.distance(probes[todo[out]])
            best[todo] = np.minimum(best[todo], d)
    samples = np.concatenate(samples) if samples else np.zeros((0, 3))
    off = distance(samples)[0]
    # The projection may end beside the nearest point: what looks too far is looked for again, all at once
    # from more places, and what is left one by one, the worst first.
    for body in bodies:
        from_more_places(verify, exchange, body, probes, best, 0.99 * tolerance)
    deadline = time.monotonic() + PATIENCE
    for i in np.argsort(-best):
        if best[i] <= 0.99 * tolerance or time.monotonic() > deadline:
            break
        best[i] = closer(verify, exchange, bodies, probes[i], best[i], 0.99 * tolerance)
    worst = int(best.argmax())
    return {
        "to_mesh": float(off.max()),
        "to_surface": float(best.max()),
        "gap": 0.0,
        "diagonal": diagonal,
        "faces": len(patches),
        "worst": samples[off.argmax()].tolist(),
        "worst2": probes[worst].tolist(),
        "size": float(np.abs(points).max()),
    }


def from_more_places(verify, exchange, body: list, probes, best, enough: float) -> None:
    """Lowers the distances of all points that look too far from one surface, by projections from several
    places near each."""
    import numpy as np

    face, patch, loops, border, least, most, _ = body
    outside = np.linalg.norm(np.maximum(0, np.maximum(least - probes, probes - most)), axis=1)
    todo = np.flatnonzero((best > enough) & (outside < best))
    if not len(todo):
        return
    seeds = grid(face, patch, FINE)
    # From a pole no projection gets away: only places inside are asked. Sides are reached from there.
    low, high = np.array(face.uv[::2]), np.array(face.uv[1::2])
    seeds = seeds[((seeds > low) & (seeds < high)).all(1)]
    tree = verify.cKDTree(face.d0(seeds))
    starts = list(seeds[tree.query(probes[todo], k=PLACES)[1]].transpose(1, 0, 2))
    ended = starts[0]
    for start in [*starts, None, None]:
        # What ended on a side goes on from the opposite one: the surface may be closed there.
        start = across(face, ended) if start is None else start
        far = best[todo] > enough
        uv, d = face.project(probes[todo[far]], start[far])
        ended = start.copy()
        ended[far] = uv
        if border is not None:
            out = ~exchange.inside(patch, loops, uv)
            d[out] = border.distance(probes[todo[far][out]])
        best[todo[far]] = np.minimum(best[todo[far]], d)


def across(face, uv):
    """Parameters on a side of the domain moved to the opposite side."""
    import numpy as np

    low, high = np.array(face.uv[::2]), np.array(face.uv[1::2])
    near = 1e-9 * (high - low)
    return np.where(uv <= low + near, high, np.where(uv >= high - near, low, uv))


def closer(verify, exchange, bodies: list, p, best: float, enough: float) -> float:
    """The distance of one point from the trimmed surfaces, by ever finer grids around the best few places."""
    import numpy as np

    for body in bodies:
        face, patch, loops, border, least, most, fine = body
        if np.linalg.norm(np.maximum(0, np.maximum(least - p, p - most))) >= best:
            continue
        low, high = np.array(face.uv[::2]), np.array(face.uv[1::2])
        if fine is None:
            seeds = grid(face, patch, FINE)
            fine = body[6] = seeds, verify.cKDTree(face.d0(seeds))
        near = fine[0][fine[1].query(p, k=4)[1]]
        # At a pole the nearest seeds are one point in space, and the nearest point may lie to any side of it.
        around_it = np.repeat(near[:1], SIDES, 0)
        turned = around_it.copy()
        around_it[:, 0], turned[:, 1] = (np.linspace(low[k], high[k], SIDES) for k in (0, 1))
        sides = np.concatenate([around_it, turned])
        same = np.linalg.norm(face.d0(sides) - face.d0(near[:1]), axis=1) < enough
        for fine_uv in np.concatenate([near, sides[same]]):
            if best <= enough:
                return best
            uv = fine_uv
            size = 3 * FINE**-0.5 * (high - low)
            for _ in range(14):
                lattice = np.stack(np.meshgrid(*[np.linspace(-1, 1, 7)] * 2), -1).reshape(-1, 2)
                around = np.clip(uv + lattice * size, low, high)
                found = np.linalg.norm(face.d0(around) - p, axis=1)
                uv, size = around[found.argmin()], 0.55 * size
            if found.min() > enough:
                uv, least_found = descended(face, p, fine_uv, low, high)
                found = np.minimum(found, least_found)
            d = float(found.min())
            if border is not None and not exchange.inside(patch, loops, uv[None])[0]:
                d = float(border.distance(p[None])[0])
            best = min(best, d)
    return best


def descended(face, p, start, low, high) -> tuple:
    """The nearest place by a simplex from one place: lattices get stuck where one parameter hardly moves the
    point, at poles."""
    import numpy as np
    from scipy.optimize import minimize

    off = lambda uv: float(np.linalg.norm(face.d0(np.clip(uv, low, high)[None])[0] - p))
    step = FINE**-0.5 * (high - low)
    simplex = [start, start + [step[0], 0], start + [0, step[1]]]
    found = minimize(
        off, start, method="Nelder-Mead", options={"initial_simplex": simplex, "xatol": 1e-12, "fatol": 1e-12}
    )
    return np.clip(found.x, low, high), found.fun


def rim(face, loop, low, high) -> list:
    """The stretches of a trim within the surface, on the surface; where it leaves the domain, up to its
    border."""
    import numpy as np

    held = ((loop >= low) & (loop <= high)).all(1)
    wider = held | np.roll(held, 1) | np.roll(held, -1)
    stretches = np.split(np.arange(len(loop)), np.flatnonzero(np.diff(wider)) + 1)
    return [face.d0(np.clip(loop[s], low, high)) for s in stretches if wider[s[0]] and len(s) > 1]


class Polylines:
    """The nearest of many short segments."""

    def __init__(self, lines: list):
        import numpy as np
        from scipy.spatial import cKDTree

        self.a = np.concatenate([line[:-1] for line in lines])
        self.b = np.concatenate([line[1:] for line in lines])
        self.tree = cKDTree(0.5 * (self.a + self.b))

    def distance(self, points):
        import numpy as np

        if not len(points):
            return np.zeros(0)
        _, near = self.tree.query(points, k=min(16, len(self.a)))
        near = near.reshape(len(points), -1)
        a, d = self.a[near], self.b[near] - self.a[near]
        t = ((points[:, None] - a) * d).sum(2) / np.maximum((d * d).sum(2), 1e-300)
        foot = a + np.clip(t, 0, 1)[..., None] * d
        return np.linalg.norm(points[:, None] - foot, axis=2).min(1)


def grid(face, patch, count=8000):
    """About so many parameters over the whole surface, equally many in each span."""
    import numpy as np

    def values(knots, degree, low, high):
        inner = np.unique([k for k in knots if low <= k <= high])
        steps = max(4, round(count**0.5) // max(len(inner) - 1, 1))
        return np.unique(np.concatenate([np.linspace(a, b, steps) for a, b in zip(inner, inner[1:])]))

    u = values(patch.knots[0], patch.degree[0], face.uv[0], face.uv[1])
    v = values(patch.knots[1], patch.degree[1], face.uv[2], face.uv[3])
    return np.stack(np.meshgrid(u, v, indexing="ij"), -1).reshape(-1, 2)


def run(chordal: str, path: Path, folder: Path) -> tuple[dict | None, str]:
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    command = [chordal, "mesh", path, "-o", folder / "mesh.ply", "--report", report, "--sew", "auto", "-q"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        return None, "out of time"
    if not report.exists():
        return None, (done.stderr.strip().splitlines() or ["no word"])[-1].split(": ", 2)[-1]
    return json.loads(report.read_text()), f"{done.returncode}"


def row(args, path: Path, folder: Path) -> str:
    name = f"{path.parent.name}/{path.name}"
    told, why = run(args.binary, path, folder)
    if told is None:
        return f"| {name} |" + " |" * 11 + f" refused: {why} |"
    parts = told["sewing"]
    nearest = [o["nearest"] for p in parts for o in p["open"] if o["nearest"] is not None]
    tolerance, gap = told["options"]["tolerance"], told["max_edge_gap"]
    cells = [name, told["faces"]["total"], sum(p["open_before"] for p in parts), sum(p["open_after"] for p in parts),
             f"{max((p['largest_move'] for p in parts), default=0.0):.1e}", f"{min(nearest):.1e}" if nearest else "",
             f"{told['shells']['closed_in_file'] - told['shells']['leaking']} of {told['shells']['closed_in_file']}", f"{tolerance:.3g}", f"{gap:.1e}"]
    command = [sys.executable, __file__, "--child", args.verify, str(path), str(folder / "mesh.ply"), str(folder / "report.json")]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT)
        found = json.loads(done.stdout.strip().splitlines()[-1])
    except subprocess.TimeoutExpired:
        return "| " + " | ".join(map(str, cells + ["", "", "", "the check ran out of time"])) + " |"
    except (json.JSONDecodeError, IndexError):
        last = (done.stderr.strip().splitlines() or ["no word"])[-1][:80]
        return "| " + " | ".join(map(str, cells + ["", "", "", f"not checked: {last}"])) + " |"
    slack = ROUNDING * (found["diagonal"] + found["size"])
    allowed = tolerance + max(gap, found["gap"]) + slack
    worst = max(found["to_mesh"], found["to_surface"])
    verdict = "within" if worst <= allowed else f"**{worst / allowed:.3g} ×**"
    print(json.dumps({"file": name, **found}), file=sys.stderr)
    cells += [f"{found['to_mesh']:.3g}", f"{found['to_surface']:.3g}", f"{found['gap']:.1e}", verdict]
    return "| " + " | ".join(map(str, cells)) + " |"


def main() -> None:
    if sys.argv[1:2] == ["--child"]:
        verifier, path, mesh, report = sys.argv[2:]
        print("\n" + json.dumps(child(verifier, Path(path), mesh, Path(report)), default=float))
        return
    parser = parser_of(__doc__)
    add_binary(parser)
    add_verifier(parser)
    add_models(parser, "folder with one folder per format")
    parser.add_argument("--only", nargs="*", default=[""])
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    if args.verify is None:
        parser.error("--verify is needed")
    lines = [
        "| file | faces | open before | open after | largest move | nearest opening | watertight | tolerance | gap | surface → mesh"
        " | mesh → surface | other kernel's gap | within tolerance + gap |",
        "|" + "---|" * 13,
    ]
    print("\n".join(lines))
    with tempfile.TemporaryDirectory() as folder:
        for kind in FOLDERS:
            for path in sorted(p for p in (args.models / kind).iterdir() if p.suffix not in SKIPPED):
                if any(part in path.name for part in args.only):
                    lines.append(row(args, path, Path(folder)))
                    print(lines[-1], flush=True)
    if args.out:
        args.out.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
