#!/usr/bin/env python3
"""Writes the scenes of the comparison: one for each kind of light, of lens and of surface.

    python3 tests/mitsuba/scenes.py FOLDER

Prints a line for each: the file, how it is compared, `exact` (compare.py) or `approximate`
(blocks.py, with Mitsuba's own material), and the samples per pixel and seed that it takes.  Here are the lights and the lens, all Lambert.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import surfaces
from glb import cube, looking, turn, write_hdr
from stage import EYE, GREEN, LOOK_AT, RED, WHITE, YFOV, hang_lamp, stage


def area(folder: Path) -> None:
    """A lamp overhead that shines downwards only, in a mirrored node; a small glowing block."""
    glb = stage()
    hang_lamp(glb, [9, 8, 6])
    glow = glb.mesh(cube(), glb.material(GREEN, [0.5, 2, 4]))
    glb.node(mesh=glow, translation=[-0.3, 0.3, 0.9], rotation=turn(40), scale=[0.15, 0.15, 0.15])
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


LIGHTS = [area, lens, point, spot, directional, constant, environment]
SCENES = [*LIGHTS, *surfaces.SCENES]
COMPARISONS = [
    *((make, "exact", 64) for make in LIGHTS),
    *((make, "exact", 32) for make in surfaces.SCENES),
    (surfaces.rough_metal, "approximate", 64),
]

if __name__ == "__main__":
    if len(sys.argv) != 2:
        print("usage: scenes.py FOLDER", file=sys.stderr)
        sys.exit(2)
    target = Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    for make in SCENES:
        make(target)
    for make, mode, spp in COMPARISONS:
        print(f"{make.__name__}.glb {mode} {spp}")
