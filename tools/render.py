#!/usr/bin/env python3
"""Draws a mesh to a PNG with flat shading: for looking at results without a window system.

    tools/render.py MESH -o out.png [--edges] [--views iso,top] [--size 700]

Orthographic, by a software z-buffer. The light follows the camera. Back faces are red, so that an inverted
triangle is seen at once. With --edges, mesh edges are drawn, and edges with one triangle are orange. Needs
numba, numpy, trimesh and pillow (tools/requirements.txt).
"""

from __future__ import annotations

import argparse
import math

# view name -> direction from the model to the eye, up vector
VIEWS: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "iso": ((1, -1.2, 0.8), (0, 0, 1)),
    "iso2": ((-1, 1.1, 0.7), (0, 0, 1)),
    "below": ((1, -1.2, -0.8), (0, 0, 1)),
    "top": ((0, 0, 1), (0, 1, 0)),
    "bottom": ((0, 0, -1), (0, 1, 0)),
    "front": ((0, -1, 0), (0, 0, 1)),
    "back": ((0, 1, 0), (0, 0, 1)),
    "left": ((-1, 0, 0), (0, 0, 1)),
    "right": ((1, 0, 0), (0, 0, 1)),
}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("mesh")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--edges", action="store_true", help="draw the mesh edges")
    parser.add_argument("--views", default="iso", help=f"comma separated, of: {', '.join(VIEWS)}")
    parser.add_argument("--size", type=int, default=700, help="pixels per view (default 700)")
    args = parser.parse_args()
    if unknown := [view for view in args.views.split(",") if view not in VIEWS]:
        parser.error(f"unknown view: {', '.join(unknown)}")
    # Imported here, so that --help needs nothing but Python.
    from PIL import Image
    from z_buffer import draw, load

    points, faces = load(args.mesh)
    pictures = [draw(points, faces, VIEWS[view], args.size, args.edges) for view in args.views.split(",")]
    columns = math.ceil(math.sqrt(len(pictures)))
    sheet = Image.new("RGB", (columns * args.size, -(-len(pictures) // columns) * args.size), "white")
    for i, picture in enumerate(pictures):
        sheet.paste(picture, (i % columns * args.size, i // columns * args.size))
    sheet.save(args.output)


if __name__ == "__main__":
    main()
