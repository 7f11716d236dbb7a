"""The stage of all scenes of the comparison, about 4 m wide.

Floor, back wall, one red and one blue side wall, open to the front and above, with a few blocks.
They use indices of 8, 16 and 32 bits, nested nodes, mirrored and uneven scales, a matrix, and node
translations far from zero, so that a slip in reading glTF shows too.
"""

from __future__ import annotations

from glb import Glb, cube, turn

WHITE = [0.75, 0.74, 0.72]
OCHRE = [0.7, 0.5, 0.25]
RED = [0.65, 0.12, 0.1]
BLUE = [0.15, 0.25, 0.65]
GREEN = [0.2, 0.6, 0.25]
# Where the cameras stand, what they look at, their vertical field of view.
EYE, LOOK_AT, YFOV = [0.4, 1.6, 5.2], [0.1, 0.8, 0], 0.68


def stage(back_wall: float = 2.2, materials: dict[str, dict] | None = None) -> Glb:
    """The stage with three blocks, without camera and light.

    `materials` replace those of the white floor, its block and so on; with them, every quad has
    texture coordinates: (0, 1), (1, 1), (1, 0), (0, 0).
    """
    glb = Glb()
    colors = {"white": WHITE, "ochre": OCHRE, "red": RED, "blue": BLUE, "green": GREEN}
    paint = {name: glb.material(color) for name, color in colors.items()}
    for name, item in (materials or {}).items():
        glb.lists["materials"][paint[name]] = item
    uv = [[0, 1], [1, 1], [1, 0], [0, 0]]

    def mesh(quads, name, index_type):
        coordinates = {"TEXCOORD_0": uv * len(quads)} if materials is not None else {}
        return glb.mesh(quads, paint[name], index_type, **coordinates)

    h, low = back_wall, 1.2
    walls = {
        "white": [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]],
        "ochre": [[-2, 0, -2], [2, 0, -2], [2, h, -2], [-2, h, -2]],
        "red": [[-2, 0, 2], [-2, 0, -2], [-2, low, -2], [-2, low, 2]],
        "blue": [[2, 0, -2], [2, 0, 2], [2, low, 2], [2, low, -2]],
    }
    for name, quad in walls.items():
        glb.node(mesh=mesh([quad], name, 5121))
    # One cube's mesh, placed thrice: turned and stretched, mirrored, and as the child of a child.
    white, green = mesh(cube(), "white", 5125), mesh(cube(), "green", 5123)
    glb.node(mesh=white, translation=[-0.8, 0.75, -0.6], rotation=turn(25), scale=[0.4, 0.7, 0.35])
    glb.node(mesh=green, translation=[0.9, 0.4, 0.1], rotation=turn(-20), scale=[-0.35, 0.35, 0.45])
    outer = glb.node(translation=[1000.1, 0, 3], rotation=turn(90))
    inner = glb.node(outer, translation=[2.6, 0.2, -999.9], scale=[0.5, 0.5, 0.5])
    glb.node(inner, mesh=white, rotation=turn(10), scale=[0.3, 0.3, 0.5])
    return glb


def hang_lamp(glb: Glb, radiance: list[float], height: float = 1.75, size: float = 1) -> None:
    """A lamp overhead that shines downwards only, in a mirrored node; and the camera."""
    lamp = glb.mesh(
        [[[-0.5, 0, 0.4], [0.5, 0, 0.4], [0.5, 0, -0.4], [-0.5, 0, -0.4]]],
        glb.material(WHITE, radiance),
    )
    # The quad faces up; mirrored in y it faces down.
    glb.node(mesh=lamp, translation=[0.2, height, -0.3], scale=[size, -1, size])
    glb.camera(EYE, LOOK_AT, YFOV)
