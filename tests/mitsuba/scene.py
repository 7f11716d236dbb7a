"""Our glTF scenes as Mitsuba 3 scenes.

here                                                Mitsuba
--------------------------------------------------  -----------------------------------------
Lambert: metallic 0, KHR_materials_specular 0       `diffuse`
mirror: metallic 1, roughness < 0.03, F₀ = 1        `conductor`, material `none`
metallic-roughness                                  `plugins.Surface`, our own formulas, or
                                                    Mitsuba's `principled`, which is another
                                                    model of the same thing
glass: transmission 1, roughness < 0.03             `dielectric` (a closed mesh or a thickness)
                                                    or `thindielectric`, in vacuum
textures, KHR_texture_transform, COLOR_0            `bitmap`, `mesh_attribute`, `plugins.Product`
normalTexture on flat faces                         `normalmap`, on each side its own
smooth normals; TANGENT off the coordinates' own    `plugins.Surface`; else noted
scattering on both sides                            `twosided`
alphaMode BLEND; MASK                               `mask`; with `plugins.Cutoff`; `volpath`
emission, W m⁻² sr⁻¹, from the front face           `area`, with the normals of the faces
KHR_materials_unlit                                 the same, scattering nothing
KHR_lights_punctual: point, directional             `point`, `directional`
KHR_lights_punctual: spot, inner ≈ outer angle      `spot`
camera                                              `perspective`
camera with extras lensRadius, focusDistance        `thinlens`
scene extras environment, environmentRotation       `constant`, `envmap`
K, the most edges of a path                         `max_depth`

What is not in the table is refused: `Unusable` names it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import mitsuba as mi
import numpy as np

import variant
from gltf import Gltf, Unusable, normalized
from materials import OURS, rgb
from meshes import Mesh, meshes, ply

KNOWN_EXTENSIONS = {
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_texture_transform",
}
# A spot's edge is hard if it is narrower than this share of the angle.
HARD_EDGE = 1e-3


@dataclass
class Scene:
    """A glTF scene, ready to become a Mitsuba scene of any size."""

    meshes: list[Mesh] = field(default_factory=list)
    emitters: list[dict] = field(default_factory=list)
    camera: dict = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    # Models that stand for what Mitsuba does not have, see `materials`.
    models: set[str] = field(default_factory=set)
    # Of Mitsuba, in which it must be rendered.
    variant: str = variant.PLAIN
    # Does anything let a part of the light through, by alpha?
    alpha: bool = False
    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))
    extent: float = 1.0


def load(path: Path, model: str = OURS) -> Scene:
    """Reads a scene and maps everything that does not depend on the size of the picture.

    `model` says what stands for the materials that Mitsuba does not have.
    """
    mi.set_variant(variant.PLAIN)
    try:
        return _load(Gltf(path), model)
    except (KeyError, IndexError, TypeError, AttributeError) as error:
        raise Unusable(
            f"{path}: not a valid glTF file ({type(error).__name__}: {error})"
        ) from error


def _load(gltf: Gltf, model: str) -> Scene:
    unknown = set(gltf.items("extensionsUsed")) - KNOWN_EXTENSIONS
    if unknown:
        raise Unusable(f"{gltf.path}: no mapping for the extension {sorted(unknown)[0]}")
    scene, placed = Scene(), gltf.placed()
    for node, world in placed:
        if "mesh" in node:
            for primitive in gltf.items("meshes")[node["mesh"]]["primitives"]:
                found, models = meshes(gltf, primitive, world, model, scene.notes)
                scene.meshes += found
                scene.models |= models
    scene.alpha = any(item.bsdf["type"] == "mask" for item in scene.meshes)
    scene.variant = mi.variant()
    if not scene.meshes:
        raise Unusable(f"{gltf.path}: the scene has no triangles")
    corners = np.concatenate([m.corners.reshape(-1, 3) for m in scene.meshes])
    low, high = corners.min(axis=0), corners.max(axis=0)
    # Mitsuba computes in f32 and offsets rays by a share of their largest coordinate, so it gets
    # the scene around its origin.
    scene.origin, scene.extent = 0.5 * (low + high), float(np.linalg.norm(high - low))
    for node, world in placed:
        index = node.get("extensions", {}).get("KHR_lights_punctual", {}).get("light")
        if index is not None:
            light = gltf.root["extensions"]["KHR_lights_punctual"]["lights"][index]
            scene.emitters.append(punctual(light, world, scene, f"{gltf.path}: light {index}"))
        if "camera" in node and not scene.camera:
            name = f"{gltf.path}: camera {node['camera']}"
            scene.camera = camera(gltf.items("cameras")[node["camera"]], world, scene, name)
    scene.emitters += environment(gltf)
    if not scene.camera:
        raise Unusable(
            f"{gltf.path}: no perspective camera (the one the program adds is its own affair)"
        )
    if not scene.emitters and not any(item.emitter for item in scene.meshes):
        raise Unusable(f"{gltf.path}: nothing emits (the program's own lamp is its own affair)")
    return scene


def to_mitsuba(scene: Scene, folder: Path, size: tuple[int, int], max_edges: int) -> dict:
    """The scene for `mi.load_dict`; meshes are written into `folder`, to last until then."""
    mi.set_variant(scene.variant)
    film = {
        "type": "hdrfilm",
        "width": size[0],
        "height": size[1],
        "pixel_format": "rgb",
        "component_format": "float32",
        "rfilter": {"type": "box"},
    }
    result = {
        "type": "scene",
        "integrator": {
            # `path` counts what alpha lets through as an edge, and its shadow rays stop there.
            "type": "volpath" if scene.alpha else "path",
            "max_depth": max_edges,
            # A roulette that begins beyond the last edge: none.
            "rr_depth": max_edges + 1,
        },
        "sensor": {**scene.camera, "film": film, "sampler": {"type": "independent"}},
    }
    for i, item in enumerate(scene.meshes):
        file = Path(folder) / f"mesh{i}.ply"
        file.write_bytes(ply(item, scene.origin))
        shape = {
            "type": "ply",
            "filename": str(file),
            "face_normals": item.normals is None,
            "bsdf": item.bsdf,
        }
        if item.emitter:
            shape["emitter"] = item.emitter
        if item.attributes:
            shape = mi.load_dict(shape)
            for name, values in item.attributes.items():
                shape.add_attribute(name, values.shape[1], values.astype(np.float32).ravel())
        result[f"mesh{i}"] = shape
    result.update({f"emitter{i}": emitter for i, emitter in enumerate(scene.emitters)})
    return result


def punctual(light: dict, world: np.ndarray, scene: Scene, name: str) -> dict:
    """A light of KHR_lights_punctual, W sr⁻¹ or W m⁻²; it shines along the node's −Z."""
    power = rgb(light.get("intensity", 1.0) * np.array(light.get("color", [1, 1, 1]), float))
    position, direction = world[:3, 3] - scene.origin, -normalized(world[:3, 2])
    if "range" in light:
        scene.notes.append(
            f"{name}: its range is ignored, light falls off with the square of the distance"
        )
    if light["type"] == "point":
        return {"type": "point", "position": position.tolist(), "intensity": power}
    if light["type"] == "directional":
        return {"type": "directional", "direction": direction.tolist(), "irradiance": power}
    if light["type"] != "spot":
        raise Unusable(f"{name}: no mapping for a light of type '{light['type']}'")
    inner, outer = (
        light.get("spot", {}).get(key, default)
        for key, default in (("innerConeAngle", 0), ("outerConeAngle", math.pi / 4))
    )
    if not 0 < outer <= math.pi / 2 or outer - inner > HARD_EDGE * outer:
        raise Unusable(
            f"{name}: a spot with a soft edge (only innerConeAngle ≈ outerConeAngle is mapped)"
        )
    # Across the edge glTF's factor is a square (mean 1/3), Mitsuba's is linear (mean 1/2): two
    # thirds of the width carry the same.
    edge = max(outer - inner, 1e-6 * outer)
    return {
        "type": "spot",
        "intensity": power,
        "beam_width": math.degrees(outer - edge),
        "cutoff_angle": math.degrees(outer - edge / 3),
        "to_world": look(position, direction, world[:3, 1]),
    }


def camera(json: dict, world: np.ndarray, scene: Scene, name: str) -> dict:
    """The sensor without its film: it looks along the node's −Z, +Y is up."""
    if "perspective" not in json:
        return {}
    result = {
        "type": "perspective",
        "fov_axis": "y",
        "fov": math.degrees(json["perspective"]["yfov"]),
        "near_clip": 1e-4 * scene.extent,
        "far_clip": 1e3 * scene.extent,
        "to_world": look(world[:3, 3] - scene.origin, -world[:3, 2], world[:3, 1]),
    }
    lens = json.get("extras", {})
    if lens.get("lensRadius", 0) > 0:
        if not lens.get("focusDistance", 0) > 0:
            raise Unusable(f"{name}: a lens without a focusDistance")
        result.update(
            type="thinlens",
            aperture_radius=lens["lensRadius"],
            focus_distance=lens["focusDistance"],
        )
    return result


def look(position: np.ndarray, axis: np.ndarray, up: np.ndarray):
    """Local +Z along `axis`, +Y towards `up`; +X then is the picture's left, as in Mitsuba."""
    axis = normalized(axis)
    up = normalized(up - axis * np.dot(up, axis))
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([np.cross(up, axis), up, axis, position])
    return mi.ScalarTransform4f(matrix)


def environment(gltf: Gltf) -> list[dict]:
    """The surroundings: constant, or an equirectangular map with −Z at its centre, +Y at its top.

    Our texel centres lie at ((i + ½)/W, (j + ½)/H), bilinear between them, u wraps, v clamps.
    Mitsuba's first and last rows lie at v = 0 and 1, its columns at u = (i + s)/W with s = ½ or,
    in older versions, 0.  The map is handed over on a lattice that contains all our knots, so both
    are the same function.  Our u = ½ is Mitsuba's u = 0: half a turn.
    """
    extras = gltf.scene().get("extras") or {}
    value = extras.get("environment")
    if value is None:
        return []
    if not isinstance(value, str):
        return [{"type": "constant", "radiance": rgb(value)}] if any(value) else []
    file = gltf.path.parent / value
    try:
        texels, shift = rgb_picture(file), column_shift()
    except RuntimeError as error:
        raise Unusable(f"{gltf.path}: the environment '{file}' cannot be read") from error
    height, width = texels.shape[:2]
    fine = np.arange(width) + 0.5 if shift else np.arange(2 * width) / 2
    fine = interpolated(texels, fine - 0.5, np.arange(2 * height + 1) / 2 - 0.5)
    turn = mi.ScalarTransform4f().rotate([0, 1, 0], 180 + extras.get("environmentRotation", 0.0))
    return [{"type": "envmap", "bitmap": mi.Bitmap(fine.astype(np.float32)), "to_world": turn}]


def rgb_picture(file: Path) -> np.ndarray:
    """A picture file's linear RGB, [y, x, channel]."""
    bitmap = mi.Bitmap(str(file))
    return np.array(bitmap.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False), float)


def interpolated(texels: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Our interpolant on the lattice of `x` and `y`, in texels from the first one's centre."""
    height, width = texels.shape[:2]
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = (x - left)[None, :, None], (y - top)[:, None, None]
    rows = [np.clip(top + i, 0, height - 1) for i in (0, 1)]
    cols = [(left + i) % width for i in (0, 1)]
    upper, lower = ((1 - fx) * texels[r][:, cols[0]] + fx * texels[r][:, cols[1]] for r in rows)
    return (1 - fy) * upper + fy * lower


def column_shift() -> float:
    """Where Mitsuba puts the centre of a map's first column: at ½, or at 0 in older versions."""
    texels = np.zeros((3, 4, 3), np.float32)
    texels[:, 0] = 1
    emitter = mi.load_dict({"type": "envmap", "bitmap": mi.Bitmap(texels)})
    at = mi.SurfaceInteraction3f()
    at.wi = mi.Vector3f(0, 0, 1)
    return 0.5 if emitter.eval(at)[0] < 0.75 else 0.0
