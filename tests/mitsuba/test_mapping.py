#!/usr/bin/env python3
"""The mapping to Mitsuba: closed forms, conventions, refusals.

    python3 tests/mitsuba/test_mapping.py

Here only Mitsuba renders: these tests find slips of ours in its conventions, or changes of them.
"""

from __future__ import annotations

import math
import tempfile
import unittest
from pathlib import Path

import mitsuba as mi
import numpy as np

from gltf import Unusable, normalized
from scene import Scene, interpolated, load, to_mitsuba
from glb import Glb, cube, looking, write_hdr
from scenes import SCENES, sky

RHO = [0.8, 0.5, 0.2]
# A floor of 20 m, which a path meets once.
FLOOR = [[[-10, 0, 10], [10, 0, 10], [10, 0, -10], [-10, 0, -10]]]
# The square from −1 to 1 in the plane z = 0, facing +Z.
SQUARE = [[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]]


class Scenes(unittest.TestCase):
    """Tests that render small scenes."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def render(self, glb: Glb, size=(16, 16), max_edges=2, spp=16) -> np.ndarray:
        """The picture, [y, x, channel]."""
        glb.write(self.folder / "scene.glb")
        return self.rendered(load(self.folder / "scene.glb"), size, max_edges, spp)

    def rendered(self, scene: Scene, size=(16, 16), max_edges=2, spp=16) -> np.ndarray:
        """The picture, [y, x, channel]."""
        loaded = mi.load_dict(to_mitsuba(scene, self.folder, size, max_edges))
        return np.array(mi.render(loaded, spp=spp), float)

    def near(self, found, wanted, relative=2e-3):
        """Equal up to a share of the largest value wanted."""
        wanted = np.broadcast_to(wanted, np.shape(found))
        scale = relative * np.abs(wanted).max()
        np.testing.assert_allclose(found, wanted, rtol=0, atol=scale)


def light(kind: str, color: list[float], intensity: float, **more) -> dict:
    """A light of KHR_lights_punctual."""
    return {"type": kind, "color": color, "intensity": intensity, **more}


def floor(position=(1.0, 4.0, 0.5), target=(1.0, 0.0, 0.5), yfov=0.6) -> Glb:
    """A floor seen from above; the picture's top is −Z, its right is +X."""
    glb = Glb()
    glb.node(mesh=glb.mesh(FLOOR, glb.material(RHO)))
    glb.camera(position, target, yfov)
    return glb


def floor_points(position, yfov, size) -> np.ndarray:
    """What the centres of the pixels of `floor` show."""
    width, height = size
    x, y = np.meshgrid(
        (np.arange(width) + 0.5) * 2 / width - 1, 1 - (np.arange(height) + 0.5) * 2 / height
    )
    half = position[1] * math.tan(yfov / 2)
    return np.stack(
        [position[0] + x * half * width / height, 0 * x, position[2] - y * half], axis=-1
    )


class ClosedForms(Scenes):
    """Radiance that can be written down."""

    def test_point_light(self):
        """ρ/π · I cos θ / d², and which way is right and up in a picture that is not square."""
        glb, size = floor(), (48, 32)
        glb.light(light("point", [1, 0.5, 0.25], 40), translation=[2.2, 1.5, -0.4])
        to = np.array([2.2, 1.5, -0.4]) - floor_points((1.0, 4.0, 0.5), 0.6, size)
        d = np.linalg.norm(to, axis=-1, keepdims=True)
        wanted = np.array(RHO) / math.pi * 40 * np.array([1, 0.5, 0.25]) * (to[..., 1:2] / d) / d**2
        self.near(self.render(glb, size, spp=64), wanted, 5e-3)

    def test_spot(self):
        """The same inside a cone about the node's −Z, nothing outside."""
        glb, size = floor(), (32, 32)
        place, aim, angle = np.array([0.2, 3.0, 1.0]), np.array([1.1, 0.0, 0.3]), 0.2
        matrix = looking(place, aim)
        spot = {"innerConeAngle": angle * 0.9999, "outerConeAngle": angle}
        glb.light(light("spot", [1, 1, 1], 10, spot=spot), matrix=matrix)
        to = place - floor_points((1.0, 4.0, 0.5), 0.6, size)
        d = np.linalg.norm(to, axis=-1, keepdims=True)
        off_axis = np.arccos(np.sum(-to / d * normalized(aim - place), axis=-1))
        lit = np.array(RHO) / math.pi * 10 * (to[..., 1:2] / d) / d**2
        picture = self.render(glb, size, spp=64)
        # A pixel is 0.08 m, the cone's radius there 0.63 m: leave out the pixels on its edge.
        for inside in (True, False):
            some = off_axis < angle - 0.03 if inside else off_axis > angle + 0.03
            self.assertGreater(some.sum(), 50)
            self.near(picture[some], lit[some] if inside else 0 * lit[some], 5e-3)

    def test_directional(self):
        """ρ/π · E cos θ, E measured across the light's direction."""
        glb = floor()
        glb.light(light("directional", [1, 1, 0.5], 3), matrix=looking([3, 4, 0], [0, 0, 0]))
        self.near(self.render(glb), np.array(RHO) / math.pi * 3 * 0.8 * np.array([1, 1, 0.5]))

    def test_constant_environment(self):
        """ρ L on a floor, also from below; L seen directly."""
        for y, target in ((4.0, 0.0), (-4.0, 0.0), (4.0, 8.0)):
            glb = floor((1.0, y, 0.5), (1.0, target, 0.5))
            glb.extras["environment"] = [0.5, 1.0, 2.0]
            albedo = np.array(RHO) if target == 0 else 1.0
            self.near(
                self.render(glb, spp=256).mean(axis=(0, 1)),
                albedo * np.array([0.5, 1.0, 2.0]),
                1e-2,
            )

    def test_environment_map(self):
        """A map seen directly, in six directions, plain and turned: what our formula says."""
        width, height, size = 16, 8, (24, 18)
        u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
        write_hdr(self.folder / "map.hdr", sky(2 * np.pi * (u - 0.5), np.pi * v))
        texels = np.array(mi.Bitmap(str(self.folder / "map.hdr")), float)[..., :3]
        self.near(texels, sky(2 * np.pi * (u - 0.5), np.pi * v), 1e-2)
        for axis in np.concatenate([np.eye(3), -np.eye(3)]):
            for rotation in (0.0, 50.0):
                glb = Glb()
                glb.node(
                    mesh=glb.mesh(SQUARE, glb.material(RHO)),
                    translation=[0, 0, 5000],
                    scale=[1e-3, 1e-3, 1e-3],
                )
                glb.camera([0, 0, 0], axis, 1.0)
                glb.extras.update(environment="map.hdr", environmentRotation=rotation)
                wanted = np.zeros((size[1], size[0], 3))
                matrix = np.array(looking([0, 0, 0], axis)).reshape(4, 4).T[:3, :3]
                for y in range(size[1]):
                    for x in range(size[0]):
                        tan = math.tan(0.5)
                        film = [
                            (2 * (x + 0.5) / size[0] - 1) * tan * size[0] / size[1],
                            (1 - 2 * (y + 0.5) / size[1]) * tan,
                            -1,
                        ]
                        wanted[y, x] = looked_up(texels, normalized(matrix @ film), rotation)
                self.near(self.render(glb, size, 1, spp=64), wanted, 2e-2)

    def test_environment_lights_what_it_faces(self):
        """A bright half of the map, +X, lights a wall that faces +X and not one that faces −X."""
        texels = np.full((8, 16, 3), 0.001)
        texels[:, 10:14] = 1.0
        write_hdr(self.folder / "map.hdr", texels)
        for side in (1, -1):
            glb = Glb()
            glb.node(
                mesh=glb.mesh(
                    [[[0, -9, 9 * side], [0, -9, -9 * side], [0, 9, -9 * side], [0, 9, 9 * side]]],
                    glb.material(RHO),
                )
            )
            glb.camera([2 * side, 0, 0], [0, 0, 0], 0.3)
            glb.extras["environment"] = "map.hdr"
            picture = self.render(glb, spp=64).mean()
            self.assertGreater(picture, 0.2) if side == 1 else self.assertLess(picture, 0.02)

    def test_camera(self):
        """Right is right, up is up, and the vertical angle is yfov, whatever the aspect."""
        # Emitters at distance 1 that reach from the centre to half of the film.
        tan = math.tan(0.4)
        for size in ((40, 20), (20, 40)):
            glb = Glb()
            for color, place in (
                ([1, 0, 0], [tan / 4, 0, -1]),
                ([0, 1, 0], [0, tan / 4, -1.0001]),
            ):
                scale = [tan / 4, 20, 1] if place[0] else [20, tan / 4, 1]
                glb.node(
                    mesh=glb.mesh(SQUARE, glb.material([0, 0, 0], color)),
                    translation=place,
                    scale=scale,
                )
            glb.camera([0, 0, 0], [0, 0, -1], 0.8)
            picture = self.render(glb, size, 1, spp=4)
            x, y = np.meshgrid(
                np.arange(size[0]) + 0.5 - size[0] / 2, size[1] / 2 - np.arange(size[1]) - 0.5
            )
            reach = size[1] / 4
            self.near(picture[..., 0], ((x > 0) & (x < reach)) * 1.0, 1e-3)
            self.near(
                picture[..., 1], ((y > 0) & (y < reach) & ~((x > 0) & (x < reach))) * 1.0, 1e-3
            )

    def test_lens(self):
        """The edge of a bright plane: sharp in focus, also off the axis; else a disk's share."""
        focus, radius, size, tan = 2.0, 0.3, (40, 8), math.tan(0.15)
        for depth in (focus, 1.5 * focus):
            glb = Glb()
            # Bright to the left of x = 0.6 of the film's half width.
            edge = 0.6 * tan * size[0] / size[1] * depth
            glb.node(
                mesh=glb.mesh(SQUARE, glb.material([0, 0, 0], [1, 1, 1])),
                translation=[edge - 50, 0, -depth],
                scale=[50, 50, 1],
            )
            glb.camera([0, 0, 0], [0, 0, -1], 0.3, {"lensRadius": radius, "focusDistance": focus})
            found = self.render(glb, size, 1, spp=1024).mean(axis=0)[:, 0]
            # Through the lens point l, the slope m sees l (1 − depth/focus) + m depth.
            m = ((np.arange(40 * size[0]) + 0.5) * 2 / (40 * size[0]) - 1) * tan * size[0] / size[1]
            with np.errstate(divide="ignore"):
                s = (
                    np.clip((m * depth - edge) / (depth / focus - 1) / radius, -1, 1)
                    if depth > focus
                    else np.sign(m * depth - edge)
                )
            share = (np.arccos(s) - s * np.sqrt(1 - s * s)) / math.pi
            self.near(found, share.reshape(size[0], 40).mean(axis=1), 1.5e-2)

    def test_emitters_shine_from_their_front(self):
        """Also where a mirrored node turns the mesh inside out twice over."""
        for scale, back in ((1, False), (1, True), (-1, False), (-1, True)):
            glb = Glb()
            glb.node(mesh=glb.mesh(SQUARE, glb.material(RHO, [2, 2, 2])), scale=[scale, 1, 1])
            glb.camera([0, 0, -5 if back else 5], [0, 0, 0], 0.1)
            self.near(self.render(glb), 0.0 if back else 2.0)

    def test_mirror_and_glass(self):
        """A mirror shows all, a thin pane (1 − R)/(1 + R), a solid one of K = 3 (1 − R)²."""
        reflectance = 0.2**2
        glass = {
            "extensions": {
                "KHR_materials_transmission": {"transmissionFactor": 1},
                "KHR_materials_ior": {"ior": 1.5},
            }
        }
        glass["pbrMetallicRoughness"] = {"metallicFactor": 0, "roughnessFactor": 0}
        mirror = {
            "pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0},
            "extensions": {},
        }
        cases = [
            (mirror, SQUARE, [0, 0, 4], 2, 1.0),
            (glass, SQUARE, [0, 0, -4], 2, (1 - reflectance) / (1 + reflectance)),
            (glass, cube(), [0, 0, -4], 3, (1 - reflectance) ** 2),
        ]
        for material, quads, lamp, edges, wanted in cases:
            glb = Glb()
            glb.node(mesh=glb.mesh(quads, glb.push("materials", material)), scale=[1, 1, 0.1])
            turned = {"rotation": [0, 1, 0, 0]} if lamp[2] > 0 else {}
            glb.node(
                mesh=glb.mesh(SQUARE, glb.material([0, 0, 0], [1, 1, 1])),
                translation=lamp,
                scale=[3, 3, 1],
                **turned,
            )
            glb.camera([0, 0, 3], [0, 0, 0], 0.02)
            self.near(self.render(glb, max_edges=edges, spp=1024).mean(), wanted, 5e-3)

    def test_far_from_zero(self):
        """The picture does not depend on where the scene is."""
        for offset in (0.0, 1e6):
            glb = Glb()
            parent = glb.node(translation=[offset, 0, 0])
            glb.node(parent, mesh=glb.mesh(FLOOR, glb.material(RHO)))
            glb.light(light("point", [1, 1, 1], 10), parent, translation=[0, 1, 0])
            camera = glb.camera([0, 3, 0], [0, 0, 0], 0.02)
            glb.roots.remove(camera)
            glb.lists["nodes"][parent]["children"].append(camera)
            self.near(self.render(glb).mean(axis=(0, 1)), np.array(RHO) * 10 / math.pi, 2e-2)


def looked_up(texels: np.ndarray, direction: np.ndarray, rotation: float) -> np.ndarray:
    """Our environment's radiance, straight from its definition."""
    height, width = texels.shape[:2]
    x, y, z = direction
    # World phi = map phi − rotation.
    phi, theta = math.atan2(x, -z) + math.radians(rotation), math.acos(np.clip(y, -1, 1))
    u, v = (phi / (2 * math.pi) + 0.5) % 1.0, theta / math.pi
    column, row = u * width - 0.5, v * height - 0.5
    i, j = math.floor(column), math.floor(row)
    fx, fy = column - i, row - j

    def texel(i, j):
        return texels[min(max(j, 0), height - 1), i % width]

    upper = (1 - fx) * texel(i, j) + fx * texel(i + 1, j)
    lower = (1 - fx) * texel(i, j + 1) + fx * texel(i + 1, j + 1)
    return (1 - fy) * upper + fy * lower


class Lattice(unittest.TestCase):
    """The finer map that Mitsuba gets."""

    def test_interpolant(self):
        """At any place, the interpolant is that of the definition."""
        rng = np.random.default_rng(1)
        texels = rng.random((5, 7, 3))
        u, v = rng.random(20), rng.random(20)
        found = interpolated(texels, u * 7 - 0.5, v * 5 - 0.5)
        for i in range(20):
            for j in range(20):
                phi, theta = 2 * math.pi * (u[i] - 0.5), math.pi * v[j]
                sin = math.sin(theta)
                d = np.array([math.sin(phi) * sin, math.cos(theta), -math.cos(phi) * sin])
                np.testing.assert_allclose(found[j, i], looked_up(texels, d, 0.0), atol=1e-6)


class Refusals(Scenes):
    """What cannot be mapped is named."""

    def refused(self, glb: Glb, word: str):
        """Loading names `word`."""
        glb.write(self.folder / "bad.glb")
        with self.assertRaisesRegex(Unusable, word):
            load(self.folder / "bad.glb")

    def test_materials(self):
        """Each is one change to a Lambert material."""
        cases = [
            ({"doubleSided": True, "emissiveFactor": [1, 1, 1]}, "double-sided"),
            ({"alphaMode": "BLEND", "emissiveFactor": [1, 1, 1]}, "alpha"),
            (
                {"extensions": {"KHR_materials_specular": {"specularTexture": {"index": 0}}}},
                "textures of an extension",
            ),
            (
                {"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}}},
                "not clear",
            ),
            (
                {
                    "pbrMetallicRoughness": {
                        "roughnessFactor": 0,
                        "baseColorFactor": [0.9, 1, 1, 1],
                    },
                    "extensions": {},
                },
                "Schlick",
            ),
            ({"extensions": {"KHR_materials_sheen": {}}}, "KHR_materials_sheen"),
        ]
        for change, word in cases:
            glb = floor()
            glb.extras["environment"] = [1, 1, 1]
            glb.lists["materials"][0].update(change)
            self.refused(glb, word)

    def test_what_the_program_would_add(self):
        """A scene without a light, a scene without a camera."""
        self.refused(floor(), "nothing emits")
        glb = floor()
        glb.extras["environment"] = [1, 1, 1]
        glb.lists["cameras"][0]["type"] = "orthographic"
        del glb.lists["cameras"][0]["perspective"]
        self.refused(glb, "camera")

    def test_lights(self):
        """A soft spot, an unknown light, a missing map."""
        for kind, word in (("spot", "soft edge"), ("tube", "tube")):
            glb = floor()
            glb.light(light(kind, [1, 1, 1], 1))
            self.refused(glb, word)
        glb = floor()
        glb.extras["environment"] = "missing.hdr"
        self.refused(glb, "missing.hdr")

    def test_files(self):
        """No file, no glTF, a buffer that is cut short."""
        with self.assertRaisesRegex(Unusable, "cannot be read"):
            load(self.folder / "none.glb")
        for data in (b"hello", b"glTF", b"[]", b'{"scenes": [{"nodes": [7]}]}'):
            (self.folder / "bad.gltf").write_bytes(data)
            with self.assertRaises(Unusable):
                load(self.folder / "bad.gltf")
        glb = floor()
        glb.data = glb.data[:20]
        self.refused(glb, "beyond")

    def test_the_generated_scenes_are_not(self):
        """Every one of them loads."""
        for make in SCENES:
            make(self.folder)
            self.assertEqual(load(self.folder / f"{make.__name__}.glb").notes, [])


if __name__ == "__main__":
    unittest.main()
