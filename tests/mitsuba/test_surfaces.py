#!/usr/bin/env python3
"""The mapping of surfaces to Mitsuba: normal maps, metal, coats, each with what must not fit.

python3 tests/mitsuba/test_surfaces.py
"""

from __future__ import annotations

import math
import unittest

import numpy as np

from glb import looking
from gltf import normalized
from materials import PRINCIPLED
from scene import load
from test_mapping import RHO, Scenes
from test_textures import UV, lambert, stage


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

    def test_given(self):
        """NORMAL off the face's, and a map whose TANGENT is not along +u: our own surface."""
        texel = np.array([[[204, 166, 230]]])
        x, y, z = normalized(texel[0, 0] / 127.5 - 1)
        up = normalized(np.array([0.3, 1, 0.2]))
        # ⊥ up, and not along +X.
        tangent = normalized(np.array([1, 0, 1]) - up * np.dot(up, [1, 0, 1]))
        for sign in (1, -1):
            for mapped in (False, True):
                attributes = {"TEXCOORD_0": UV, "NORMAL": [up], "TANGENT": [[*tangent, sign]]}
                n = up
                if mapped:
                    n = x * tangent + y * sign * np.cross(up, tangent) + z * up
                for to in ([2, 5, 1], [-4, 2, -3], [5, 0.3, 1], [-5, 0.3, 1], [4, -0.3, 2]):
                    glb = stage(lambert(), **attributes)
                    if mapped:
                        glb.lists["materials"][0]["normalTexture"] = glb.texture(texel)
                    glb.lists["nodes"][-1]["matrix"] = looking(to, [0, 0, 0])
                    cos = np.dot(n, normalized(np.array(to))) if to[1] > 0 else 0
                    found = self.render(glb, spp=16).mean(axis=(0, 1))
                    np.testing.assert_allclose(found, np.array(RHO) * max(cos, 0), atol=4e-3)


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
