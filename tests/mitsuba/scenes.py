#!/usr/bin/env python3
"""Writes the scenes of the comparison: one for each kind of light and lens, all Lambert.

    python3 tests/mitsuba/scenes.py FOLDER

Each is a stage (floor, back wall, one red and one blue side wall, open to the front and above)
with a few blocks, about 4 m wide.  Between them they use indices of 8, 16 and 32 bits, nested
nodes, mirrored and uneven scales, a matrix, and node translations far from zero, so that a slip
in reading glTF shows too.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from glb import Glb, cube, looking, turn, write_hdr

WHITE = [0.75, 0.74, 0.72]
OCHRE = [0.7, 0.5, 0.25]
RED = [0.65, 0.12, 0.1]
BLUE = [0.15, 0.25, 0.65]
GREEN = [0.2, 0.6, 0.25]
# Where the cameras stand, what they look at, their vertical field of view.
EYE, LOOK_AT, YFOV = [0.4, 1.6, 5.2], [0.1, 0.8, 0], 0.68


def stage(back_wall: float = 2.2) -> Glb:
    """The stage with three blocks, without camera and light."""
    glb = Glb()
    colors = {"white": WHITE, "ochre": OCHRE, "red": RED, "blue": BLUE, "green": GREEN}
    paint = {name: glb.material(color) for name, color in colors.items()}
    h, low = back_wall, 1.2
    walls = {
        "white": [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]],
        "ochre": [[-2, 0, -2], [2, 0, -2], [2, h, -2], [-2, h, -2]],
        "red": [[-2, 0, 2], [-2, 0, -2], [-2, low, -2], [-2, low, 2]],
        "blue": [[2, 0, -2], [2, 0, 2], [2, low, 2], [2, low, -2]],
    }
    for name, quad in walls.items():
        glb.node(mesh=glb.mesh([quad], paint[name], 5121))
    # One cube's mesh, placed thrice: turned and stretched, mirrored, and as the child of a child.
    white, green = glb.mesh(cube(), paint["white"], 5125), glb.mesh(cube(), paint["green"], 5123)
    glb.node(mesh=white, translation=[-0.8, 0.75, -0.6], rotation=turn(25), scale=[0.4, 0.7, 0.35])
    glb.node(mesh=green, translation=[0.9, 0.4, 0.1], rotation=turn(-20), scale=[-0.35, 0.35, 0.45])
    outer = glb.node(translation=[1000.1, 0, 3], rotation=turn(90))
    inner = glb.node(outer, translation=[2.6, 0.2, -999.9], scale=[0.5, 0.5, 0.5])
    glb.node(inner, mesh=white, rotation=turn(10), scale=[0.3, 0.3, 0.5])
    return glb


def area(folder: Path) -> None:
    """A lamp overhead that shines downwards only, in a mirrored node; a small glowing block."""
    glb = stage()
    lamp = glb.mesh(
        [[[-0.5, 0, 0.4], [0.5, 0, 0.4], [0.5, 0, -0.4], [-0.5, 0, -0.4]]],
        glb.material(WHITE, [9, 8, 6]),
    )
    # The quad faces up; mirrored in y it faces down.
    glb.node(mesh=lamp, translation=[0.2, 1.75, -0.3], scale=[1, -1, 1])
    glow = glb.mesh(cube(), glb.material(GREEN, [0.5, 2, 4]))
    glb.node(mesh=glow, translation=[-0.3, 0.3, 0.9], rotation=turn(40), scale=[0.15, 0.15, 0.15])
    glb.camera(EYE, LOOK_AT, YFOV)
    glb.write(folder / "area.glb")


def lens(folder: Path) -> None:
    """A wide lens, focused before the stage: blocks, walls and the lamp that faces it blur."""
    glb = stage()
    lamp = glb.mesh(
        [[[-0.3, 0, 0], [0.3, 0, 0], [0.3, 0.5, 0], [-0.3, 0.5, 0]]],
        glb.material(WHITE, [10, 9, 7]),
    )
    glb.node(mesh=lamp, translation=[0.7, 1.5, -1.7])
    top = [[-1, 0, 1], [-1, 0, -1], [1, 0, -1], [1, 0, 1]]
    overhead = glb.mesh([top], glb.material(WHITE, [3, 3, 4]))
    glb.node(mesh=overhead, translation=[-0.3, 2.6, 0.8])
    near = glb.mesh(cube(), glb.material(RED))
    glb.node(mesh=near, translation=[-0.45, 1.15, 3.2], scale=[0.12, 0.12, 0.12])
    glb.camera(EYE, LOOK_AT, YFOV, {"lensRadius": 0.3, "focusDistance": 3.2})
    glb.write(folder / "lens.glb")


def point(folder: Path) -> None:
    """A point light, the child of a scaled node (which must not change its intensity)."""
    glb = stage()
    parent = glb.node(translation=[0, 1, 0], scale=[2, 2, 2])
    light = {"type": "point", "color": [1, 0.8, 0.5], "intensity": 12}
    glb.light(light, parent, translation=[-0.2, 0.45, 0.5])
    glb.camera(EYE, LOOK_AT, YFOV)
    glb.write(folder / "point.glb")


def spot(folder: Path) -> None:
    """A spot whose hard edge runs over floor, blocks and a wall."""
    glb = stage()
    # glTF wants inner < outer; so narrow an edge is beyond what a picture shows.
    cone = {"innerConeAngle": 0.45 * (1 - 1e-4), "outerConeAngle": 0.45}
    light = {"type": "spot", "color": [1, 0.9, 0.7], "intensity": 30, "spot": cone}
    glb.light(light, matrix=looking([1.6, 2.8, 2.2], [-0.3, 0.3, -0.3]))
    glb.camera(EYE, LOOK_AT, YFOV)
    glb.write(folder / "spot.glb")


def directional(folder: Path) -> None:
    """A sun from the right, over the camera's shoulder."""
    glb = stage()
    light = {"type": "directional", "color": [1, 0.9, 0.75], "intensity": 5}
    glb.light(light, matrix=looking([1.2, 1.8, 1.4], [0, 0, 0]))
    glb.camera(EYE, LOOK_AT, YFOV)
    glb.write(folder / "directional.glb")


def constant(folder: Path) -> None:
    """An even sky."""
    glb = stage(1.3)
    glb.extras["environment"] = [0.6, 0.8, 1.1]
    glb.camera(EYE, LOOK_AT, YFOV)
    glb.write(folder / "constant.glb")


def environment(folder: Path) -> None:
    """A map, turned by 40°: a broad bright lobe behind the camera, another colour on each side."""
    glb = stage(1.3)
    glb.extras.update(environment="environment.hdr", environmentRotation=40.0)
    glb.camera(EYE, LOOK_AT, YFOV)
    glb.write(folder / "environment.glb")
    width, height = 64, 32
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    write_hdr(folder / "environment.hdr", sky(2 * np.pi * (u - 0.5), np.pi * v))


def sky(phi: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """A smooth sky, of no symmetry, by azimuth (0 is −Z, +X follows) and angle from +Y."""
    to = np.stack(
        [np.sin(phi) * np.sin(theta), np.cos(theta), -np.cos(phi) * np.sin(theta)], axis=-1
    )
    lobe = np.exp(8 * (to @ (np.array([-0.5, 0.6, 0.62]) / np.linalg.norm([-0.5, 0.6, 0.62])) - 1))
    sides = 0.5 + 0.45 * np.stack(
        [to[..., 0], -to[..., 0] * 0.6 + to[..., 1] * 0.4, -to[..., 2]], axis=-1
    )
    return 0.8 * sides + 6 * lobe[..., None] * np.array([1, 0.85, 0.6])


SCENES = [area, lens, point, spot, directional, constant, environment]

if __name__ == "__main__":
    if len(sys.argv) != 2:
        print("usage: scenes.py FOLDER", file=sys.stderr)
        sys.exit(2)
    target = Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    for make in SCENES:
        make(target)
    print("\n".join(f"{make.__name__}.glb" for make in SCENES))
