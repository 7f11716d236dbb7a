#!/usr/bin/env python3
"""The mapping of textures to Mitsuba: colours, alpha, emission, each with what must not fit.

python3 tests/mitsuba/test_textures.py
"""

from __future__ import annotations

import math
import unittest

import numpy as np

from glb import Glb, looking
from test_mapping import FLOOR, RHO, Scenes, floor_points, light

UV = [[0, 1], [1, 1], [1, 0], [0, 0]]
EYE, YFOV = (1.0, 4.0, 0.5), 0.6
# A texture of no symmetry, sRGB and alpha.
TEXELS = np.random.default_rng(5).integers(20, 256, (3, 4, 4))


def linear(texels: np.ndarray) -> np.ndarray:
    """sRGB decoded, as IEC 61966-2-1 says; alpha as it is."""
    x = texels / 255
    decoded = np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)
    return np.concatenate([decoded[..., :3], x[..., 3:]], axis=-1)


def looked_up(texels: np.ndarray, uv: np.ndarray, wraps=("repeat", "repeat")) -> np.ndarray:
    """Bilinear between texel centres, straight from the definition; uv: […, 2]."""
    height, width = texels.shape[:2]

    def index(i, n, wrap):
        if wrap == "repeat":
            return i % n
        if wrap == "mirror":
            return n - 1 - np.abs(i % (2 * n) - n + 0.5).astype(int)
        return np.minimum(np.maximum(i, 0), n - 1)

    x, y = uv[..., 0] * width - 0.5, uv[..., 1] * height - 0.5
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    total = 0
    for di, dj in ((0, 0), (1, 0), (0, 1), (1, 1)):
        weight = np.abs(1 - di - (x - i)) * np.abs(1 - dj - (y - j))
        texel = texels[index(j + dj, height, wraps[1]), index(i + di, width, wraps[0])]
        total = total + weight[..., None] * texel
    return total


def seen(function, size=(24, 16), fine=8) -> np.ndarray:
    """What the pixels of `stage` show of a function of the floor's points, averaged."""
    points = floor_points(EYE, YFOV, (size[0] * fine, size[1] * fine))
    value = function(points)
    return value.reshape(size[1], fine, size[0], fine, -1).mean(axis=(1, 3))


def stage(material: dict, below=False, **attributes) -> Glb:
    """A floor of a material under a light of π W m⁻² from straight above: it shows its albedo."""
    glb = Glb()
    quad = glb.mesh(FLOOR, glb.push("materials", material), **attributes)
    glb.node(mesh=quad, **({"rotation": [0, 0, 1, 0]} if below else {}))
    glb.camera(EYE, (1.0, 0.0, 0.5), YFOV)
    glb.light(light("directional", [1, 1, 1], math.pi), matrix=looking([0, 5, 0], [0, 0, 0]))
    return glb


def lambert(**more) -> dict:
    """A Lambert material, without its textures."""
    pbr = {"metallicFactor": 0, "baseColorFactor": [*RHO, 1], **more.pop("pbr", {})}
    specular = {"KHR_materials_specular": {"specularFactor": 0}}
    return {"pbrMetallicRoughness": pbr, "extensions": specular, **more}


class Textures(Scenes):
    """Colours, alpha, emission, coordinates."""

    def compared(self, glb: Glb, wanted: np.ndarray, wrong: np.ndarray, **how):
        """The picture is the one and not the other."""
        found = self.render(glb, (24, 16), spp=256, **how)
        self.near(found, wanted, 2e-2)
        with self.assertRaises(AssertionError):
            self.near(found, wrong, 2e-2)

    def test_color(self):
        """Wrap modes, also different ones, and a transform; not upside down, not still encoded."""
        names = {"repeat": 10497, "clamp": 33071, "mirror": 33648}
        # The floor's coordinates run from −1 to 1.5; its points give them.
        low, high = -1.0, 1.5
        uv = np.array(UV) * (high - low) + low

        def coordinates(p):
            return low + (high - low) * (np.stack([p[..., 0], p[..., 2]], axis=-1) + 10) / 20

        scale, offset, angle = (4.0, 3.0), (0.3, -1.3), 0.5
        c, s = math.cos(angle), math.sin(angle)
        turn = np.array([[c, s], [-s, c]])
        for wraps in (("repeat",) * 2, ("clamp",) * 2, ("mirror",) * 2, ("repeat", "clamp")):
            glb = stage(lambert(), TEXCOORD_1=uv)
            texture = glb.texture(TEXELS, [names[wrap] for wrap in wraps])
            moved = glb.transformed(
                {**texture, "texCoord": 1}, scale=scale, offset=offset, rotation=angle
            )
            glb.lists["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = moved

            def albedo(p, texels=linear(TEXELS), turn=turn, wraps=wraps):
                at = (coordinates(p) * np.array(scale)) @ turn.T + np.array(offset)
                return np.array(RHO) * looked_up(texels[..., :3], at, wraps)

            wanted = seen(albedo)
            for wrong in (
                seen(lambda p: albedo(p, linear(TEXELS)[::-1])),
                seen(lambda p: albedo(p, TEXELS / 255)),
                seen(lambda p: albedo(p, turn=turn.T)),
            ):
                self.compared(glb, wanted, wrong)

    def test_vertex_colors(self):
        """COLOR_0 times the factor, alone and, as bytes, times a texture."""
        corners = np.array([[1, 0.2, 0.2], [0, 1, 0.6], [0.4, 0.4, 1], [1, 1, 1]])
        for textured in (False, True):
            glb = stage(lambert(), TEXCOORD_0=UV, COLOR_0=corners)
            if textured:
                rows = np.concatenate([corners * 255, np.zeros((4, 1))], axis=1).round()
                view = glb.view(rows.astype("u1").tobytes())
                item = {"bufferView": view, "componentType": 5121, "normalized": True}
                color = glb.push("accessors", {**item, "count": 4, "type": "VEC4"})
                glb.lists["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = color
            if textured:
                texture = glb.texture(TEXELS)
                glb.lists["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = texture

            def albedo(p, share=1.0, textured=textured):
                x, y = (p[..., :1] + 10) / 20, (10 - p[..., 2:]) / 20
                # Two triangles: corners 0 1 2 and 0 2 3.
                below = corners[0] + x * (corners[1] - corners[0]) + y * (corners[2] - corners[1])
                above = corners[0] + x * (corners[2] - corners[3]) + y * (corners[3] - corners[0])
                uv = np.concatenate([x, 1 - y], axis=-1)
                texel = looked_up(linear(TEXELS)[..., :3], uv) if textured else 1.0
                return np.array(RHO) * np.where(y < x, below, above) ** share * texel

            self.compared(glb, seen(albedo), seen(lambda p: albedo(p, 0.5)))

    def test_emission(self):
        """A texture seen directly, and the light that it casts."""
        texels = np.zeros((2, 2, 3), int)
        texels[0, 0] = texels[1, 1] = 255
        for direct in (True, False):
            glb = stage(lambert())
            glb.lights.clear()
            glb.lists["nodes"].pop()
            glb.roots.pop()
            factor = {"emissiveFactor": [1, 0.5, 0], "extensions": {}}
            factor["extensions"] = {
                **lambert()["extensions"],
                "KHR_materials_emissive_strength": {"emissiveStrength": 3},
            }
            lamp = glb.push("materials", {**lambert(), **factor})
            glb.lists["materials"][lamp]["emissiveTexture"] = glb.texture(texels, [33071, 33071])
            # A square of 2 m at height 1, facing down; its +u is −X, its +v is −Z.
            quad = [[[2, 1, -0.5], [2, 1, 1.5], [0, 1, 1.5], [0, 1, -0.5]]]
            uv = [[0, 1], [0, 0], [1, 0], [1, 1]]
            if direct:
                quad = [quad[0][::-1]]
                uv = uv[::-1]
            glb.node(mesh=glb.mesh(quad, lamp, TEXCOORD_0=uv))
            found = self.render(glb, (24, 16), spp=4096, max_edges=1 if direct else 2)

            def emitted(x, z):
                at = np.stack([(2 - x) / 2, (1.5 - z) / 2], axis=-1)
                value = looked_up(texels / 255, at, ("clamp", "clamp"))
                return value * [3, 1.5, 0]

            if direct:
                # At height 1 the camera, at 4, sees three quarters of the floor's extent.
                p = floor_points(EYE, YFOV, (24 * 8, 16 * 8))
                x, z = (EYE[i] + 0.75 * (p[..., i] - EYE[i]) for i in (0, 2))
                inside = (np.abs(x - 1) < 1) & (np.abs(z - 0.5) < 1)
                wanted = np.where(inside[..., None], emitted(x, z), 0)
                wanted = wanted.reshape(16, 8, 24, 8, 3).mean(axis=(1, 3))
                self.near(found, wanted, 5e-2)
                continue
            side = (np.arange(40) + 0.5) / 20 - 1
            x, z = np.meshgrid(1 + side, 0.5 + side)
            p = floor_points(EYE, YFOV, (24, 16))
            d = (p[..., 0, None, None] - x) ** 2 + (p[..., 2, None, None] - z) ** 2 + 1
            e = np.einsum("yxij,ijc->yxc", 0.05**2 / d**2, emitted(x, z))
            # The camera sees the lamp's dark back before the middle of the floor.
            shown = (np.abs(p[..., 0] - 1) > 1.4) & (np.abs(p[..., 2] - 0.5) < 0.6)
            self.assertGreater(shown.sum(), 10)
            wanted = np.array(RHO) / math.pi * e[shown]
            self.near(found[shown], wanted, 8e-2)
            self.near(found[shown].mean(axis=0), wanted.mean(axis=0), 1e-2)

    def test_alpha(self):
        """Floor through black sheets, which light and eye both cross; K counts no crossing."""
        alpha = np.full((2, 2, 4), 255)
        alpha[..., 3] = [[0, 0], [255, 255]]
        for mode, factor, texture, wanted in (
            ("BLEND", 0.3, None, 0.7**2),
            ("OPAQUE", 0.3, None, 0.0),
            ("MASK", 0.6, None, 0.0),
            ("MASK", 0.4, None, 1.0),
            ("MASK", 1.0, alpha, None),
            ("BLEND", 0.8, alpha, None),
        ):
            glb = stage(lambert())
            pbr = {"baseColorFactor": [0, 0, 0, factor]}
            if texture is not None:
                pbr["baseColorTexture"] = glb.texture(texture, [33071, 33071])
            sheet = glb.push("materials", lambert(pbr=pbr, alphaMode=mode))
            glb.node(
                mesh=glb.mesh(FLOOR, sheet, TEXCOORD_0=UV), translation=[0, 1, 0], scale=[0.4] * 3
            )
            found = self.render(glb, (24, 16), spp=256)
            if wanted is not None:
                self.near(found.mean(axis=(0, 1)), np.array(RHO) * wanted, 2e-2)
                continue

            def through(p):
                # The eye's ray and the light's cross the sheet at different places.
                v = [(z + 4) / 8 for z in (EYE[2] + 0.75 * (p[..., 2] - EYE[2]), p[..., 2])]
                a = [np.clip((x * 2 - 0.5), 0, 1) for x in v]
                a = [x >= 0.5 for x in a] if mode == "MASK" else [factor * x for x in a]
                return ((1 - a[0]) * (1 - a[1]))[..., None] * np.array(RHO)

            self.near(found.mean(axis=1), seen(through, fine=32).mean(axis=1), 2e-2)

    def test_unlit(self):
        """The base colour, texture and all, whatever shines on it; it lights nothing but by that."""
        glb = stage({**lambert(), "extensions": {"KHR_materials_unlit": {}}}, TEXCOORD_0=UV)
        pbr = glb.lists["materials"][0]["pbrMetallicRoughness"]
        pbr["baseColorTexture"] = glb.texture(TEXELS)

        def shown(p, encoded=False):
            texels = TEXELS / 255 if encoded else linear(TEXELS)
            uv = (np.stack([p[..., 0], p[..., 2]], axis=-1) + 10) / 20
            return np.array(RHO) * looked_up(texels[..., :3], uv)

        self.compared(glb, seen(shown), seen(lambda p: shown(p, True)))


if __name__ == "__main__":
    unittest.main()
