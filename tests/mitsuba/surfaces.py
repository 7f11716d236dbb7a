"""The comparison's scenes of surfaces: `scenes.py` writes them.  One for each thing."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from glb import cube, turn
from stage import BLUE, EYE, GREEN, LOOK_AT, OCHRE, RED, WHITE, YFOV, hang_lamp, stage

REPEAT, CLAMP, MIRROR = 10497, 33071, 33648
# A lamp above what the camera sees: its edges would be most of the noise.
LAMP = {"radiance": [9, 8, 6], "height": 3, "size": 2}
# The corners of a quad in a picture.
UV = [[0, 1], [1, 1], [1, 0], [0, 0]]


def pbr(color: list[float], **more) -> dict:
    """A material."""
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], **more}}


def lambert(color: list[float], **more) -> dict:
    """A Lambert material."""
    specular = {"KHR_materials_specular": {"specularFactor": 0}}
    return {**pbr(color, metallicFactor=0), "extensions": specular, **more}


def noise(seed: int, *shape: int) -> np.ndarray:
    """Bytes of no symmetry."""
    return np.random.default_rng(seed).integers(30, 256, shape)


def rough_metal(folder: Path) -> None:
    """A rough white floor (F₀ = 1), blocks of rougher copper and of smoother gold."""
    glb = stage(
        materials={
            "white": pbr([1, 1, 1], roughnessFactor=0.7),
            "green": pbr([0.95, 0.64, 0.54], roughnessFactor=0.45),
        }
    )
    block = glb.push("materials", pbr([1.0, 0.78, 0.34], roughnessFactor=0.3, metallicFactor=0.8))
    small = {"scale": [0.2, 0.3, 0.2], "rotation": turn(30)}
    glb.node(mesh=glb.mesh(cube(), block), translation=[0.1, 0.3, 0.9], **small)
    hang_lamp(glb, **LAMP)
    glb.write(folder / "rough_metal.glb")


def coat(folder: Path) -> None:
    """Coats: a rough floor, a glossy block with a texture of both, KHR_materials_specular, _ior."""
    glossy = pbr(GREEN, metallicFactor=1, roughnessFactor=1)
    glb = stage(
        materials={
            "white": pbr(WHITE, metallicFactor=0, roughnessFactor=0.5),
            "green": glossy,
            "ochre": {
                **pbr(OCHRE, metallicFactor=0, roughnessFactor=0.35),
                "extensions": {
                    "KHR_materials_specular": {
                        "specularFactor": 0.8,
                        "specularColorFactor": [1, 0.6, 0.3],
                    },
                    "KHR_materials_ior": {"ior": 1.9},
                },
            },
        }
    )
    texels = noise(1, 4, 4, 3)
    texels[..., 1] = 80 + texels[..., 1] // 2
    glossy["pbrMetallicRoughness"]["metallicRoughnessTexture"] = glb.texture(texels)
    hang_lamp(glb, **LAMP)
    glb.write(folder / "coat.glb")


def textured(folder: Path) -> None:
    """Lambert with pictures that repeat, mirror and end, turned, scaled and moved."""
    items = {name: lambert(color) for name, color in (("white", WHITE), ("ochre", OCHRE))}
    items["green"] = lambert([1, 1, 1])
    glb = stage(materials=items)
    moves = {
        "white": ((REPEAT, REPEAT), {"scale": [3, 2], "rotation": 0.4}),
        "ochre": ((MIRROR, MIRROR), {"scale": [3, 2], "offset": [-1.2, 0.3]}),
        "green": ((CLAMP, REPEAT), {"scale": [2, 2], "offset": [-0.5, -0.5], "rotation": 0.2}),
    }
    for seed, (name, (wraps, move)) in enumerate(moves.items()):
        texture = glb.transformed(glb.texture(noise(seed + 2, 5, 4, 3), wraps), **move)
        items[name]["pbrMetallicRoughness"]["baseColorTexture"] = texture
    hang_lamp(glb, **LAMP)
    glb.write(folder / "textured.glb")


def alpha(folder: Path) -> None:
    """Sheets: one with holes before the stage, one between lamp and blocks that dims."""
    glb = stage()
    texels = noise(7, 4, 6, 4)
    sheets = {
        "MASK": ([0.8, 0.7, 0.3], {"alphaCutoff": 0.6}, [-0.2, 0.5, 1.4], [0.9, 0.5, 1], None),
        "BLEND": (BLUE, {}, [0.3, 1.3, -0.2], [1.2, 0.8, 1], [-0.6, 0, 0, 0.8]),
    }
    for mode, (color, more, place, scale, rotation) in sheets.items():
        sheet = lambert(color, alphaMode=mode, **more)
        sheet["pbrMetallicRoughness"]["baseColorTexture"] = glb.texture(texels, (CLAMP, MIRROR))
        quad = [[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]]
        mesh = glb.mesh(quad, glb.push("materials", sheet), TEXCOORD_0=UV)
        glb.node(
            mesh=mesh,
            translation=place,
            scale=scale,
            **({"rotation": rotation} if rotation else {}),
        )
    hang_lamp(glb, **LAMP)
    glb.write(folder / "alpha.glb")


def bumps(seed: int) -> np.ndarray:
    """Normals up to 40° off, as a picture."""
    tilt = (noise(seed, 6, 6, 2) - 143) / 255 * 1.5
    normals = np.concatenate([tilt, np.ones((6, 6, 1))], axis=-1)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.round((normals + 1) * 127.5).astype(int)


def normal_map(folder: Path) -> None:
    """Lambert with normal maps, also in mirrored nodes, mirrored pictures, with TANGENT, scaled."""
    items = {"white": lambert(WHITE), "green": lambert(GREEN)}
    glb = stage(materials=items)
    items["white"]["normalTexture"] = glb.texture(bumps(10))
    items["green"]["normalTexture"] = {**glb.texture(bumps(11)), "scale": 0.6}
    # A sheet seen from behind; its picture is mirrored, its tangent says so.
    sheet = glb.push("materials", lambert(RED, normalTexture=glb.texture(bumps(12))))
    quad = [[[-1, -1, 0], [-1, 1, 0], [1, 1, 0], [1, -1, 0]]]
    tangent = {"TEXCOORD_0": [[0, 1], [0, 0], [1, 0], [1, 1]], "TANGENT": [[1, 0, 0, -1]]}
    node = {"translation": [-1.2, 0.5, 0.8], "rotation": turn(30), "scale": [0.4, 0.5, 1]}
    glb.node(mesh=glb.mesh(quad, sheet, **tangent), **node)
    hang_lamp(glb, **LAMP)
    glb.write(folder / "normal_map.glb")


def glow(folder: Path) -> None:
    """A lamp and an unlit sheet with pictures, and a sheet with colours at its corners."""
    glb = stage()
    lamp = lambert([0.1, 0.1, 0.1], emissiveFactor=[1, 0.9, 0.6])
    strength = {"KHR_materials_emissive_strength": {"emissiveStrength": 20}}
    lamp["extensions"] = {**lamp["extensions"], **strength}
    lamp["emissiveTexture"] = glb.texture(noise(20, 3, 4, 3), (CLAMP, CLAMP))
    down = [[[-1, 0, -0.8], [1, 0, -0.8], [1, 0, 0.8], [-1, 0, 0.8]]]
    mesh = glb.mesh(down, glb.push("materials", lamp), TEXCOORD_0=UV)
    glb.node(mesh=mesh, translation=[0.2, LAMP["height"], -0.3])
    unlit = {**pbr([0.9, 0.5, 0.7]), "extensions": {"KHR_materials_unlit": {}}}
    unlit["pbrMetallicRoughness"]["baseColorTexture"] = glb.texture(noise(21, 4, 3, 3))
    quad = [[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]]
    mesh = glb.mesh(quad, glb.push("materials", unlit), TEXCOORD_0=UV)
    place = {"translation": [-0.3, 0.4, 0.9], "rotation": turn(20), "scale": [0.3, 0.4, 1]}
    glb.node(mesh=mesh, **place)
    sheet = glb.push("materials", lambert([0.9, 0.9, 0.8]))
    colors = [[1, 0.2, 0.1], [0.1, 1, 0.2], [0.2, 0.1, 1], [1, 1, 0.1]]
    mesh = glb.mesh(quad, sheet, COLOR_0=colors)
    glb.node(mesh=mesh, translation=[0, 1.3, -1.5], scale=[1.5, 0.6, 1])
    glb.camera(EYE, LOOK_AT, YFOV)
    glb.write(folder / "glow.glb")


SCENES = [rough_metal, coat, textured, alpha, normal_map, glow]
