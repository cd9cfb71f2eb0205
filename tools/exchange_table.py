"""Files that are not STEP, as a user gets them: `exchange_table.py CHORDAL MODELS [--out TABLE.md] [--pictures FOLDER]`.

Each file is meshed with the defaults and `--sew auto` at 0.1 % of its diagonal; the figures are those of the reports, faces beside
those of MODELS/INDEX.tsv. --pictures draws some of the meshes, with their edges, on two sheets.
"""

import argparse
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDERS = ["iges", "brep", "iv", "x3d", "obj", "json", "3dm"]
SKIPPED = {".txt", ".md", ".tsv"}
TIMEOUT = 300
SHEETS = {
    "exchange": [
        "json/geomdl_trim_advanced.json", "obj/taylor_surface_tessellation__bicubic_taylor_surf.obj", "iv/sgi_teapot_ascii.iv",
        "x3d/castle_nurbs_dune_primitives.x3dv", "x3d/FredTheBunny.x3dv", "3dm/v1_Patch.3dm", "3dm/v5_ring.3dm",
        "3dm/v4_PerfumeBottle_Solid.3dm", "brep/bottle.brep", "brep/CrankArm.rle", "iges/fuse.igs", "iges/freecad_SOT404.igs"],
    "trimmed": [
        "iv/mentor_08.4.TrimSurf.iv", "x3d/HoleCentered.x3dv", "obj/scrv_surface_edges__spec_example_8.obj",
        "json/geomdl_trim_multi.json", "obj/surface_trim_clipping__remesh_exact_square_hole.obj", "json/geomdl_trim_single.json",
        "iges/hammer.iges", "iges/bearing.iges", "iges/test_pipe_hollow_out_true.iges", "3dm/v4_DinerMug.3dm", "3dm/v4_Gear.3dm",
        "3dm/v5_teacup.3dm"],
}
COLUMNS, TILE = 4, 300


def meshed(chordal: str, path: Path, mesh: Path) -> tuple[int, dict | None, str]:
    """Exit, report, and the last sentence of one run."""
    report = mesh.with_suffix(".json")
    report.unlink(missing_ok=True)
    command = [chordal, "mesh", path, "-o", mesh, "--sew", "auto", "--report", report, "-q"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        return 124, None, f"over {TIMEOUT} s"
    last = (done.stderr.strip().splitlines() or [""])[-1].split(": ", 2)[-1]
    return done.returncode, json.loads(report.read_text()) if report.exists() else None, last


def row(name: str, expected: str, code: int, told: dict | None, last: str) -> str:
    if told is None:
        return f"| {name} | | {expected} | | | | | | {code}: {last} |"
    shells, proven = told["shells"], told["proven_error"]
    cells = [name, told["faces"]["total"], expected, told["triangles"], f"{told['options']['tolerance']:.3g}",
             "none" if proven is None else f"{proven:.3g}", f"{told['max_gap']:.1e}",
             f"{shells['watertight']} of {shells['closed_in_file']}", code if code == 0 else f"{code}: {'; '.join(told['undone'])}"]
    return "| " + " | ".join(map(str, cells)) + " |"


def sheet(meshes: list[tuple[str, Path]], to: Path) -> None:
    """Pictures side by side, each with its file's name."""
    from PIL import Image, ImageDraw

    rows = -(-len(meshes) // COLUMNS)
    whole = Image.new("RGB", (COLUMNS * TILE, rows * (TILE + 18)), "white")
    for k, (name, mesh) in enumerate(meshes):
        picture = mesh.with_suffix(".png")
        subprocess.run([sys.executable, Path(__file__).parent / "render.py", mesh, "-o", picture, "--edges", "--size", str(TILE)], check=True)
        x, y = k % COLUMNS * TILE, k // COLUMNS * (TILE + 18)
        whole.paste(Image.open(picture).resize((TILE, TILE)), (x, y))
        ImageDraw.Draw(whole).text((x + 6, y + TILE + 2), name[:46], fill="black")
    whole.quantize(64).save(to, optimize=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("chordal")
    parser.add_argument("models", type=Path)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--pictures", type=Path)
    args = parser.parse_args()
    with (args.models / "INDEX.tsv").open(encoding="utf-8") as index:
        faces = {f"{r['kind']}/{r['name']}": r["occ_faces"] for r in csv.DictReader(index, delimiter="\t")}
    head = ["file", "faces", "in the index", "triangles", "tolerance, mm", "proven error, mm", "gap, mm", "watertight", "exit"]
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    drawn = {name for names in SHEETS.values() for name in names}
    with tempfile.TemporaryDirectory() as folder:
        meshes = {}
        for kind in FOLDERS:
            for path in sorted(p for p in (args.models / kind).iterdir() if p.suffix not in SKIPPED):
                name = f"{kind}/{path.name}"
                mesh = Path(folder) / f"{kind}_{path.name}.ply"
                lines.append(row(name, faces.get(name, ""), *meshed(args.chordal, path, mesh)))
                print(lines[-1], flush=True)
                if name in drawn and args.pictures:
                    meshes[name] = mesh
                else:
                    mesh.unlink(missing_ok=True)
        for title, names in SHEETS.items() if args.pictures else ():
            sheet([(name, meshes[name]) for name in names], args.pictures / f"{title}.png")
    if args.out:
        args.out.write_text("\n".join(lines) + "\n")


main()
