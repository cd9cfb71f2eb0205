"""Faces of which a mesher may take the wrong part: signed and flat surfaces, windows, slivers, folds.

    python corpus/make/region.py                    # writes corpus/region/ and its INDEX.tsv
    python corpus/make/region.py --variants OUT N   # N random variants of each kind, with their right areas

Every model has its right area by a closed form (mm²). All curves are lines and circles, all windows are
rectangles of parameters, so that the areas are exact.
"""

from __future__ import annotations

import argparse
import random
from collections.abc import Callable, Sequence
from pathlib import Path

import region_folds
import region_signed
import region_windows
from region_formats import OTHERS, band_brep, band_iges
from rings import Band, Model

FOLDER = Path(__file__).resolve().parent.parent / "region"

KINDS: dict[str, tuple[str, Callable[[random.Random | None], Model]]] = {
    "lemon_negative": ("a band of a lemon torus, its major radius negative", region_signed.lemon),
    "apple_band": ("a band of an apple torus", region_signed.apple),
    "sphere_negative": ("a sphere with a negative radius", region_signed.signed),
    "cone_nearly_flat": ("a cone 7.5e-8 off a plane, with windows", region_signed.flat_cone),
    "cone_nearly_straight": ("a cone 1e-9 off a cylinder", region_signed.steep_cone),
    "tube_perforated": ("a tube with windows all round: no straight line for a seam", region_windows.tube),
    "funnel_perforated": ("a cone with windows all round", region_windows.funnel),
    "dome_perforated": ("a cap round a pole with windows all round", region_windows.dome),
    "sphere_perforated": ("a whole sphere with windows all round", region_windows.strainer),
    "torus_band_perforated": ("a band of a torus with windows all round", region_windows.ring_band),
    "torus_perforated": ("a whole torus with windows all round one way", region_windows.ring_whole),
    "torus_blocked": ("a whole torus with windows in the way of every straight cut", region_windows.ring_blocked),
    "sliver_on_edge": ("a box with a face of no area between two edges that coincide", region_folds.sliver),
    "edge_folded": ("a closed edge that returns on its own way", region_folds.folded_edge),
    "sphere_huge": ("a small patch of a sphere with a radius of 1e10 mm", region_signed.huge),
    "curve_bounded_scattered": ("CURVE_BOUNDED_SURFACE with pieces in any order", region_signed.scattered),
    "cylinder_without_radius": ("a cylinder with a radius of zero", region_signed.no_radius),
    "fillet_thin": ("an eighth of a thin tube, for coarse tolerances", region_signed.fillet),
    "torus_horn_rounded": ("a wedge of a torus whose radii differ by rounding", region_signed.horn_wedge),
    "offset_revolved": ("the offset of a revolved circle that passes the axis", region_signed.offset_revolved),
    "offset_extruded": ("the offset of an extruded circle", region_signed.offset_extruded),
    "edge_without_length": ("an edge of no length and one that runs back over its neighbour", region_folds.no_length),
}


def write_all(folder: Path) -> None:
    folder.mkdir(exist_ok=True)
    rows = ["file\ttests\tarea\tmade_by"]
    for name, (tests, make) in KINDS.items():
        _, area, write = make(None)
        write(folder / f"{name}.step")
        rows.append(f"{name}.step\t{tests}\t{area:.9g}\t{make.__module__}.{make.__name__}")
    for file, tests, kind, sizes, ring, span in OTHERS:
        band = band_iges if file.endswith(".igs") else band_brep
        band(folder / file, kind, sizes, ring, span)
        area = Band(ring, *span, span).area()
        rows.append(f"{file}\t{tests}\t{area:.9g}\tregion_formats.{band.__name__}")
    (folder / "INDEX.tsv").write_text("\n".join(rows) + "\n", encoding="utf-8")


def write_variants(folder: Path, count: int) -> None:
    folder.mkdir(exist_ok=True, parents=True)
    rows = ["file\ttests\tarea\tmade_by"]
    for name, (tests, make) in KINDS.items():
        for k in range(count):
            _, area, write = make(random.Random(f"{name}{k}"))
            write(folder / f"{name}_{k}.step")
            rows.append(f"{name}_{k}.step\t{tests}\t{area:.9g}\t{make.__module__}.{make.__name__}")
    (folder / "INDEX.tsv").write_text("\n".join(rows) + "\n", encoding="utf-8")


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--variants", nargs=2, metavar=("OUT", "N"))
    options = parser.parse_args(arguments)
    if options.variants:
        write_variants(Path(options.variants[0]), int(options.variants[1]))
    else:
        write_all(FOLDER)


if __name__ == "__main__":
    main()
