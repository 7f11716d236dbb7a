#!/usr/bin/env python3
"""The mapping of surfaces and textures to Mitsuba: closed forms, each with what must not fit.

python3 tests/mitsuba/test_surfaces.py
"""

from __future__ import annotations

import math
import unittest

import numpy as np

from glb import Glb, looking
from gltf import normalized
from materials import PRINCIPLED
from scene import load
from test_mapping import FLOOR, RHO, SQUARE, Scenes, floor_points, light

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
        """COLOR_0 times the factor, alone and times a texture."""
        corners = np.array([[1, 0.2, 0.1], [0.1, 1, 0.5], [0.3, 0.4, 1], [1, 1, 1]])
        for textured in (False, True):
            glb = stage(lambert(), TEXCOORD_0=UV, COLOR_0=corners)
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


class Normals(Scenes):
    """Normal maps on a flat floor: ρ/π E n·l."""

    def test_side_and_handedness(self):
        """From above and from below, with the picture as it is and mirrored, scaled, by TANGENT."""
        texel = np.array([[[204, 166, 230]]])
        t = normalized(texel[0, 0] / 127.5 - 1)
        for below in (False, True):
            for mirrored in (False, True):
                for scale in (1.0, 0.5):
                    n = normalized(t * [scale, scale, 1])
                    # The floor's +u is +X and its −v is −Z, unless mirrored.
                    uv = np.array(UV) * [-1 if mirrored else 1, 1]
                    world = np.array([-n[0] if mirrored else n[0], n[2], -n[1]])
                    attributes = {"TEXCOORD_0": uv}
                    if scale == 1:
                        sign = -1 if mirrored else 1
                        attributes["TANGENT"] = [[sign, 0, 0, sign]]
                    glb = stage(lambert(), below, **attributes)
                    normal = {**glb.texture(texel), "scale": scale}
                    glb.lists["materials"][0]["normalTexture"] = normal
                    # The light comes from the side.
                    glb.lists["nodes"][-1]["matrix"] = looking([2, 5, 1], [0, 0, 0])
                    if below:
                        # Turned about Z the floor shows its back, whose normal is −n, turned.
                        world = -world * [-1, -1, 1]
                    wanted = np.array(RHO) * np.dot(world, normalized(np.array([2, 5, 1])))
                    found = self.render(glb, spp=16).mean(axis=(0, 1))
                    self.near(found, wanted, 5e-3)
                    flipped = world * [1, 1, -1]
                    wrong = np.array(RHO) * np.dot(flipped, normalized(np.array([2, 5, 1])))
                    self.assertGreater(np.abs(wrong - wanted).max(), 0.02)

    def test_facing_away(self):
        """Where the mapped normal turns away from the light or the eye, nothing is scattered."""
        texel = np.array([[[255, 128, 150]]])
        for to, eye, lit in (
            ([-2, 2, 0], (4.0, 3.0, 0.0), False),
            ([2, 2, 0], (4.0, 3.0, 0.0), True),
            ([2, 2, 0], (-4.0, 1.0, 0.0), False),
        ):
            glb = stage(lambert(), TEXCOORD_0=UV)
            glb.lists["materials"][0]["normalTexture"] = glb.texture(texel)
            glb.lists["nodes"][-1]["matrix"] = looking(to, [0, 0, 0])
            glb.lists["nodes"][-2]["matrix"] = looking(eye, [0, 0, 0])
            self.assertEqual(self.render(glb).max() > 0.01, lit)


def microfacet(wi, wo, roughness, f0, f90, separable=False):
    """D G₂ F / (4 c_i c_o), z up, [direction, channel]."""
    h = normalized(wi + wo)
    a2 = roughness**4
    d = a2 / math.pi / (h[:, 2] ** 2 * (a2 - 1) + 1) ** 2
    lost = [(np.sqrt(1 + a2 * (1 / w[..., 2] ** 2 - 1)) - 1) / 2 for w in (wi, wo)]
    g = 1 / (1 + lost[0]) / (1 + lost[1]) if separable else 1 / (1 + lost[0] + lost[1])
    shade = (1 - np.sum(wo * h, axis=-1)[:, None]) ** 5
    f = np.array(f0) * (1 - shade) + f90 * shade
    return (d * g / (4 * wi[2] * wo[:, 2]))[:, None] * f


def albedo(function, cos: float) -> np.ndarray:
    """∫ f cos θ_o dω_o, by the midpoint rule in cos² θ_o and φ."""
    square, phi = np.meshgrid((np.arange(600) + 0.5) / 600, (np.arange(600) + 0.5) / 600 * math.pi)
    sin, c = np.sqrt(1 - square), np.sqrt(square)
    wo = np.stack([sin * np.cos(phi), sin * np.sin(phi), c], axis=-1).reshape(-1, 3)
    return math.pi * function(np.array([math.sqrt(1 - cos * cos), 0, cos]), wo).mean(axis=0)


class Rough(Scenes):
    """Metal and coat under an even sky: the directional albedo."""

    def shown(self, pbr: dict, cos: float, model="ours", **extensions) -> np.ndarray:
        """What a floor in a sky of 1 looks like at an angle."""
        material = {"pbrMetallicRoughness": pbr, "extensions": extensions}
        glb = stage(material)
        glb.lights.clear()
        glb.lists["nodes"].pop()
        glb.roots.pop()
        glb.lists["nodes"][-1]["matrix"] = looking(
            [3 * math.sqrt(1 - cos * cos), 3 * cos, 0], [0, 0, 0]
        )
        glb.lists["cameras"][0]["perspective"]["yfov"] = 0.02
        glb.extras["environment"] = [1, 1, 1]
        glb.write(self.folder / "scene.glb")
        scene = load(self.folder / "scene.glb", model)
        self.assertEqual(scene.models, {model})
        return self.rendered(scene, spp=1024).mean(axis=(0, 1))

    def test_metal(self):
        """Energy with the height-correlated G₂, which is not the separable one, nor is α linear."""
        for roughness, cos in ((0.8, 0.4), (0.5, 0.3), (1.0, 0.7)):
            pbr = {"roughnessFactor": roughness, "baseColorFactor": [*RHO, 1]}
            found = self.shown(pbr, cos)

            def wanted(separable=False, roughness=roughness, cos=cos):
                return albedo(lambda i, o: microfacet(i, o, roughness, RHO, 1, separable), cos)

            self.near(found, wanted(), 4e-3)
            self.assertGreater(np.abs(wanted(True) - wanted()).max(), 6e-3)
            # Mitsuba's own is the separable one.
            self.near(self.shown(pbr, cos, PRINCIPLED), wanted(True), 4e-3)

    def test_coat(self):
        """Diffuse below a coat, and half metal, with KHR_materials_specular and _ior."""
        specular, ior = {"specularFactor": 0.7, "specularColorFactor": [1, 0.5, 0.2]}, 1.8
        for metallic, cos in ((0, 0.3), (0, 0.9), (0.5, 0.5)):
            f0 = 0.7 * (0.8 / 2.8) ** 2 * np.array([1, 0.5, 0.2])
            f90, rho = 0.7, np.array(RHO)

            def f(i, o, metallic=metallic, f0=f0, f90=f90, rho=rho, mean=None):
                mean = f0[0] * 20 / 21 + f90 / 21 if mean is None else mean
                loss = [f0[0] + (f90 - f0[0]) * (1 - w[..., 2]) ** 5 for w in (i, o)]
                diffuse = rho / math.pi * ((1 - loss[0]) * (1 - loss[1]) / (1 - mean))[:, None]
                coat = diffuse + microfacet(i, o, 0.6, f0, f90)
                return metallic * microfacet(i, o, 0.6, rho, 1) + (1 - metallic) * coat

            found = self.shown(
                {
                    "roughnessFactor": 0.6,
                    "metallicFactor": metallic,
                    "baseColorFactor": [*RHO, 1],
                },
                cos,
                KHR_materials_specular=specular,
                KHR_materials_ior={"ior": ior},
            )
            self.near(found, albedo(f, cos), 4e-3)
            wrong = albedo(lambda i, o: f(i, o, mean=f0[0]), cos)
            self.assertGreater(np.abs(wrong - albedo(f, cos)).max(), 5e-3)

    def test_metallic_roughness_texture(self):
        """G is roughness, B metallic, both linear, times the factors."""
        glb_texel = np.array([[[10, 204, 128]]])
        for model in ("ours", PRINCIPLED):
            glb = stage({"pbrMetallicRoughness": {"roughnessFactor": 0.9}}, TEXCOORD_0=UV)
            pbr = glb.lists["materials"][0]["pbrMetallicRoughness"]
            pbr["metallicRoughnessTexture"] = glb.texture(glb_texel)
            glb.write(self.folder / "scene.glb")
            textured = self.rendered(load(self.folder / "scene.glb", model))
            constant = {"roughnessFactor": 0.9 * 204 / 255, "metallicFactor": 128 / 255}
            pictures = []
            for change in ({}, {"metallicFactor": 204 / 255, "roughnessFactor": 0.9 * 128 / 255}):
                glb = stage({"pbrMetallicRoughness": {**constant, **change}})
                glb.write(self.folder / "scene.glb")
                pictures.append(self.rendered(load(self.folder / "scene.glb", model)))
            self.near(textured, pictures[0], 1e-3)
            self.assertGreater(np.abs(pictures[1] - pictures[0]).max(), 0.05)


if __name__ == "__main__":
    unittest.main()
