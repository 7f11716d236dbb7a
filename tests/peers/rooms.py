"""The three rooms of the comparison, as glTF: what each of them asks of a renderer.

A  a closed diffuse room of 2 m with two blocks and a ceiling light of 0.5 m: a path tracer's own
B  the same room, a light of 0.2 m, a mirror ball and a glass ball: caustics
C  the same room with the blocks, lit by a lamp in an opaque shade that is open to the ceiling

All surfaces are Lambert, a perfect mirror or clear glass, which every renderer has, so all render
the same scene.  The balls are fine meshes with smooth normals.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "mitsuba"))
from glb import Glb, cube, turn  # noqa: E402  (it lies there)

WHITE, RED, GREEN = [0.75, 0.75, 0.75], [0.65, 0.1, 0.1], [0.15, 0.5, 0.15]
# Half the room's width and depth; its height.
HALF, HEIGHT = 1.0, 2.0
# A ball's parts around, and from pole to pole.
SLICES, STACKS = 256, 128


def room(light: float | None, radiance: float) -> Glb:
    """The walls, a camera inside, and a light just under the ceiling of that side, if any."""
    glb, r, h = Glb(), HALF, HEIGHT
    white, red, green = (glb.material(color) for color in (WHITE, RED, GREEN))
    corners = {
        "floor": ([[-r, 0, r], [r, 0, r], [r, 0, -r], [-r, 0, -r]], white),
        "ceiling": ([[-r, h, -r], [r, h, -r], [r, h, r], [-r, h, r]], white),
        "back": ([[-r, 0, -r], [r, 0, -r], [r, h, -r], [-r, h, -r]], white),
        "front": ([[r, 0, r], [-r, 0, r], [-r, h, r], [r, h, r]], white),
        "left": ([[-r, 0, r], [-r, 0, -r], [-r, h, -r], [-r, h, r]], red),
        "right": ([[r, 0, -r], [r, 0, r], [r, h, r], [r, h, -r]], green),
    }
    for quad, paint in corners.values():
        glb.node(mesh=glb.mesh([quad], paint))
    if light is not None:
        s, y = light / 2, h - 0.002
        lamp = glb.material([0, 0, 0], [radiance, 0.9 * radiance, 0.7 * radiance])
        quad = [[-s, y, -s], [s, y, -s], [s, y, s], [-s, y, s]]
        glb.node(mesh=glb.mesh([quad], lamp))
    glb.camera([0, 1, 0.98], [0, 1, -1], 2 * math.atan(0.75))
    return glb


def blocks(glb: Glb) -> None:
    """A tall and a low block."""
    mesh = glb.mesh(cube(), 0)
    glb.node(mesh=mesh, translation=[-0.35, 0.6, -0.35], rotation=turn(18), scale=[0.28, 0.6, 0.28])
    glb.node(mesh=mesh, translation=[0.35, 0.28, 0.15], rotation=turn(-17), scale=[0.28] * 3)


def ball(glb: Glb, center: list[float], radius: float, material: int) -> None:
    """A sphere."""
    theta = np.linspace(0, np.pi, STACKS + 1)[:, None]
    phi = np.linspace(0, 2 * np.pi, SLICES + 1)[None, :]
    phi = np.where(phi == 2 * np.pi, 0.0, phi)
    y, ring = np.cos(theta) + 0 * phi, np.where((theta == 0) | (theta == np.pi), 0, np.sin(theta))
    n = np.stack([ring * np.sin(phi), y, ring * np.cos(phi)], axis=-1)
    quads = np.stack([n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]], axis=2).reshape(-1, 4, 3)
    glb.node(mesh=glb.mesh(np.array(center) + radius * quads, material, 5125, NORMAL=quads))


def a(path: Path) -> None:
    """Room A."""
    glb = room(0.5, 8.0)
    blocks(glb)
    glb.write(path)


def b(path: Path) -> None:
    """Room B."""
    glb = room(0.2, 50.0)
    mirror = {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 1, "roughnessFactor": 0}
    clear = {"metallicFactor": 0, "roughnessFactor": 0}
    extensions = {
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_ior": {"ior": 1.5},
    }
    silver = glb.push("materials", {"pbrMetallicRoughness": mirror})
    glass = glb.push("materials", {"pbrMetallicRoughness": clear, "extensions": extensions})
    ball(glb, [-0.4, 0.35, -0.4], 0.35, silver)
    ball(glb, [0.4, 0.36, 0.2], 0.35, glass)
    glb.write(path)


def c(path: Path) -> None:
    """Room C: the lamp is 0.1 m wide, its shade 0.2 m wide and high, of walls of 5 mm."""
    glb = room(None, 0)
    blocks(glb)
    x, y, z = 0.35, 0.9, 0.15
    lamp = glb.material([0, 0, 0], [300.0, 270.0, 210.0])
    s = 0.05
    quad = [[x - s, y, z + s], [x + s, y, z + s], [x + s, y, z - s], [x - s, y, z - s]]
    glb.node(mesh=glb.mesh([quad], lamp))
    mesh, half, thin = glb.mesh(cube(), 0), 0.1, 0.0025
    for dx, dz in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        place = [x + dx * half, y + 0.08, z + dz * half]
        scale = [thin if dx else half, 0.1, thin if dz else half]
        glb.node(mesh=mesh, translation=place, scale=scale)
    glb.node(mesh=mesh, translation=[x, y - 0.0125, z], scale=[half, thin, half])
    glb.write(path)


ROOMS = {"A": a, "B": b, "C": c}
