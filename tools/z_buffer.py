"""Pictures of triangle meshes by a software z-buffer: what tools/render.py draws with."""

from __future__ import annotations

import numba as nb
import numpy as np
import trimesh
from PIL import Image

# Direction from the model to the eye, and the direction that points up in the picture.
View = tuple[tuple[float, float, float], tuple[float, float, float]]

SUPERSAMPLING = 2
FRONT, BACK = np.array([0.62, 0.70, 0.82]), np.array([0.85, 0.25, 0.2])


def load(path: str) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles; vertices at the same place are one."""
    mesh = trimesh.load(path, process=False)
    if isinstance(mesh, trimesh.Scene):
        mesh = mesh.to_geometry()
    points, inverse = np.unique(np.asarray(mesh.vertices, float) + 0.0, axis=0, return_inverse=True)
    return points, inverse.ravel()[np.asarray(mesh.faces)]


def camera(view: View) -> np.ndarray:
    """Rows: right, up, towards the eye."""
    eye, up = (np.array(v, float) for v in view)
    eye /= np.linalg.norm(eye)
    right = np.cross(up, eye)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(eye, right), eye])


@nb.njit(cache=True)
def fill(
    screen: np.ndarray, faces: np.ndarray, colours: np.ndarray, image: np.ndarray, depth: np.ndarray
) -> None:
    """Draws triangles whose corners are (x, y, depth) in pixels."""
    height, width = depth.shape
    for i in range(len(faces)):
        a, b, c = screen[faces[i, 0]], screen[faces[i, 1]], screen[faces[i, 2]]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if area == 0:
            continue
        x0, x1 = max(0, int(min(a[0], b[0], c[0]))), min(width - 1, int(max(a[0], b[0], c[0])) + 1)
        y0, y1 = max(0, int(min(a[1], b[1], c[1]))), min(height - 1, int(max(a[1], b[1], c[1])) + 1)
        for y in range(y0, y1 + 1):
            for x in range(x0, x1 + 1):
                u = ((b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)) / area
                v = ((c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)) / area
                w = 1 - u - v
                if u < 0 or v < 0 or w < 0:
                    continue
                z = u * a[2] + v * b[2] + w * c[2]
                if z > depth[y, x]:
                    depth[y, x] = z
                    image[y, x] = colours[i]


@nb.njit(cache=True)
def lines(
    screen: np.ndarray,
    edges: np.ndarray,
    colours: np.ndarray,
    image: np.ndarray,
    depth: np.ndarray,
    bias: float,
) -> None:
    """Draws edges where they are not hidden by more than `bias`."""
    height, width = depth.shape
    for i in range(len(edges)):
        a, b = screen[edges[i, 0]], screen[edges[i, 1]]
        steps = int(max(abs(a[0] - b[0]), abs(a[1] - b[1]))) + 1
        for k in range(steps + 1):
            t = k / steps
            x, y = int(a[0] + t * (b[0] - a[0])), int(a[1] + t * (b[1] - a[1]))
            if 0 <= x < width and 0 <= y < height and a[2] + t * (b[2] - a[2]) + bias >= depth[y, x]:
                image[y, x] = colours[i]


def shade(points: np.ndarray, faces: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """One colour a triangle, from its normal in camera space."""
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) @ axes.T
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    light = np.array([-0.3, 0.5, 0.81])
    back = normals[:, 2] < 0
    strength = 0.25 + 0.75 * np.abs(normals @ light)
    return np.where(back[:, None], BACK, FRONT) * strength[:, None]


def draw(points: np.ndarray, faces: np.ndarray, view: View, size: int, edges: bool) -> Image.Image:
    """One view of the mesh as a square image."""
    pixels = size * SUPERSAMPLING
    axes = camera(view)
    screen = points @ axes.T
    low, high = screen.min(0), screen.max(0)
    scale = 0.92 * pixels / max((high - low)[:2].max(), 1e-300)
    screen = (screen - (low + high) / 2) * scale
    screen[:, :2] = screen[:, :2] * [1, -1] + pixels / 2
    image = np.ones((pixels, pixels, 3))
    depth = np.full((pixels, pixels), -np.inf)
    fill(screen, faces, shade(points, faces, axes), image, depth)
    if edges:
        used, colours = edge_colours(faces)
        lines(screen, used, colours, image, depth, 1.5 * SUPERSAMPLING)
    picture = Image.fromarray((np.clip(image, 0, 1) * 255).astype(np.uint8))
    return picture.resize((size, size), Image.Resampling.LANCZOS)


def edge_colours(faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Every edge once; dark, or orange where only one triangle uses it."""
    every = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    used, count = np.unique(every, axis=0, return_counts=True)
    return used, np.where((count == 1)[:, None], [1.0, 0.5, 0.0], [0.1, 0.1, 0.15])
