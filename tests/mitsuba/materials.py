"""glTF materials as Mitsuba BSDFs and emission; the table in `scene.py` lists them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from gltf import Gltf, Unusable
from textures import Texture, texture
from variant import use_plugins

# Below this roughness a surface is a Dirac.
SMOOTH = 0.03
# What replaces the materials that Mitsuba does not have.
OURS, PRINCIPLED = "ours", "principled"


def rgb(value) -> dict:
    """A colour, or a radiometric quantity per channel."""
    return {"type": "rgb", "value": [float(x) for x in value]}


def extension(item: dict, name: str) -> dict:
    """A material's extension, empty if it is not there."""
    return item.get("extensions", {}).get(f"KHR_materials_{name}", {})


@dataclass
class Skin:
    """What a material needs to know of its mesh."""

    # Does the mesh enclose a volume?  Only glass asks.
    closed: Callable[[], bool] = lambda: False
    # COLOR_0, a row of RGBA for each vertex in use.
    colors: np.ndarray | None = None
    # The texture coordinates in use, a row each.
    uv: np.ndarray | None = None
    # Does the bitangent point along +v of the texture, that is, down?
    mirrored: bool = False
    # Is there more to its normals than its faces and texture coordinates say?
    smooth: bool = False


@dataclass
class Material:
    """A glTF material, read."""

    name: str
    json: dict
    color: np.ndarray
    metallic: float
    roughness: float
    color_map: Texture | None = None
    metallic_roughness_map: Texture | None = None
    normal_map: Texture | None = None
    emissive_map: Texture | None = None
    emission: np.ndarray = field(default_factory=lambda: np.zeros(3))
    f0: np.ndarray = field(default_factory=lambda: np.zeros(3))
    f90: float = 0.0

    @property
    def alpha_mode(self) -> str:
        """OPAQUE, MASK or BLEND."""
        return self.json.get("alphaMode", "OPAQUE")

    @property
    def unlit(self) -> bool:
        """Does it shine in its base colour, and scatter nothing?"""
        return "KHR_materials_unlit" in self.json.get("extensions", {})

    def maps(self) -> list[Texture]:
        """The textures in use."""
        scattering = [] if self.unlit else [self.metallic_roughness_map, self.normal_map]
        maps = [self.color_map, self.emissive_map, *scattering]
        return [item for item in maps if item is not None]

    def tex_coord(self) -> int:
        """Which of the mesh's sets of texture coordinates they all use."""
        used = {item.tex_coord for item in self.maps()}
        if len(used) > 1:
            raise Unusable(f"{self.name}: textures on several sets of coordinates")
        return used.pop() if used else 0


def material(gltf: Gltf, index: int | None) -> Material:
    """Reads a material; None is glTF's default."""
    json = gltf.items("materials")[index] if index is not None else {}
    name = f"{gltf.path}: material {json.get('name', index)!r}"
    pbr, specular = json.get("pbrMetallicRoughness", {}), extension(json, "specular")
    for part in json.get("extensions", {}).values():
        if any(key.endswith("Texture") for key in part):
            raise Unusable(f"{name}: textures of an extension")
    result = Material(
        name,
        json,
        np.clip(np.array(pbr.get("baseColorFactor", [1, 1, 1, 1]), float), 0, 1),
        pbr.get("metallicFactor", 1.0),
        pbr.get("roughnessFactor", 1.0),
        texture(gltf, pbr.get("baseColorTexture"), True, name),
        texture(gltf, pbr.get("metallicRoughnessTexture"), False, name),
        texture(gltf, json.get("normalTexture"), False, name),
        texture(gltf, json.get("emissiveTexture"), True, name),
    )
    strength = extension(json, "emissive_strength").get("emissiveStrength", 1.0)
    result.emission = np.maximum(np.array(json.get("emissiveFactor", [0, 0, 0])) * strength, 0.0)
    if result.unlit:
        result.emission, result.emissive_map = result.color[:3], result.color_map
    ior = extension(json, "ior").get("ior", 1.5)
    result.f90 = specular.get("specularFactor", 1.0)
    color = np.array(specular.get("specularColorFactor", [1, 1, 1]), float)
    result.f0 = result.f90 * np.minimum(1, ((ior - 1) / (ior + 1)) ** 2 * color)
    return result


def emitter(item: Material, skin: Skin) -> dict | None:
    """What emits, W m⁻² sr⁻¹."""
    if not any(item.emission):
        return None
    if item.json.get("doubleSided"):
        raise Unusable(f"{item.name}: a double-sided emitter (Mitsuba's emit to one side)")
    if item.alpha_mode != "OPAQUE":
        raise Unusable(f"{item.name}: an emitter with alpha (Mitsuba's emit all the same)")
    if item.unlit and skin.colors is not None:
        raise Unusable(f"{item.name}: unlit with colours at the vertices")
    if item.emissive_map is None:
        return {"type": "area", "radiance": rgb(item.emission)}
    # Mitsuba draws points of the texture and looks for them on the mesh.
    u, v = skin.uv[:, 1] - skin.uv[:, 0], skin.uv[:, 2] - skin.uv[:, 0]
    area = 0.5 * np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum()
    inside = skin.uv.min() > -1e-6 and skin.uv.max() < 1 + 1e-6 and area < 1 + 1e-6
    if not inside or not np.array_equal(item.emissive_map.transform, np.eye(3)):
        raise Unusable(f"{item.name}: an emissive texture that repeats or is transformed")
    values = item.emissive_map.texels[..., :3] * item.emission
    return {"type": "area", "radiance": item.emissive_map.bitmap(values, skin.uv)}


def bsdf(item: Material, skin: Skin, model: str) -> tuple[dict, set[str]]:
    """How a material scatters, and which models it took.

    Inside out: the surface seen from its front, `normalmap`, `twosided`, `mask`.  Our own comes
    with normals and both sides: Mitsuba knows no tangents, and does not ask the faces' normals.
    """
    if item.unlit:
        return {"type": "diffuse", "reflectance": 0.0}, set()
    scattering, used = dirac(item, skin), set()
    if scattering is None:
        lambert = item.metallic == 0 and item.f90 == 0
        if model == OURS and (skin.smooth or not lambert):
            scattering, used = ours(item, skin), {OURS}
        elif lambert:
            scattering = {"type": "diffuse", "reflectance": color(item, skin)}
            scattering = two_sided(item, skin, scattering)
        else:
            scattering, used = two_sided(item, skin, principled(item, skin)), {PRINCIPLED}
    if item.alpha_mode == "OPAQUE":
        return scattering, used
    return {"type": "mask", "opacity": opacity(item, skin), "nested": scattering}, used


def dirac(item: Material, skin: Skin) -> dict | None:
    """Mirrors and clear glass."""
    transmission = extension(item.json, "transmission").get("transmissionFactor", 0.0)
    smooth = item.roughness < SMOOTH and not item.metallic_roughness_map
    plain = not item.maps() and skin.colors is None
    if item.metallic == 1 and smooth:
        if not plain or min(item.color[:3]) < 1:
            raise Unusable(f"{item.name}: a mirror of F0 < 1 (Mitsuba has no Schlick term)")
        return {"type": "twosided", "nested": {"type": "conductor", "material": "none"}}
    if transmission == 0:
        return None
    if item.metallic != 0 or transmission != 1 or not smooth or not plain:
        raise Unusable(f"{item.name}: glass that is not clear, or has textures")
    volume = extension(item.json, "volume")
    if extension(item.json, "specular"):
        raise Unusable(f"{item.name}: glass with KHR_materials_specular")
    if "attenuationColor" in volume and min(volume["attenuationColor"]) < 1:
        raise Unusable(f"{item.name}: absorption inside glass")
    solid = volume.get("thicknessFactor", 0) > 0 or skin.closed()
    return {
        "type": "dielectric" if solid else "thindielectric",
        "int_ior": extension(item.json, "ior").get("ior", 1.5),
        "ext_ior": 1.0,
        "specular_transmittance": rgb(item.color[:3]),
    }


def ours(item: Material, skin: Skin) -> dict:
    """Metallic-roughness by our own formulas."""
    use_plugins()
    surface = {"type": "gltf_surface", "color": color(item, skin), **metallic_roughness(item, skin)}
    if item.normal_map:
        surface["normals"] = normals(item, skin, 1)
    return {**surface, "f0": rgb(item.f0), "f90": float(item.f90)}


def principled(item: Material, skin: Skin) -> dict:
    """What Mitsuba has instead."""
    root = min(max(item.f0), 0.99) ** 0.5
    surface = {"type": "principled", "base_color": color(item, skin), "spec_tint": 0.0}
    return {**surface, **metallic_roughness(item, skin), "eta": (1 + root) / (1 - root)}


def metallic_roughness(item: Material, skin: Skin) -> dict:
    """Both, numbers or textures; both models take α = roughness²."""
    values = {"roughness": item.roughness, "metallic": item.metallic}
    if item.metallic_roughness_map:
        for i, name in ((1, "roughness"), (2, "metallic")):
            texels = item.metallic_roughness_map.texels[..., i : i + 1] * values[name]
            values[name] = item.metallic_roughness_map.bitmap(texels, skin.uv)
    return values


def color(item: Material, skin: Skin) -> dict:
    """ρ: a colour or a texture; the factor is in COLOR_0 if there is one, see `vertex_colors`."""
    vertices = {"type": "mesh_attribute", "name": "vertex_color"}
    if item.color_map is None:
        return rgb(item.color[:3]) if skin.colors is None else vertices
    factor = item.color[:3] if skin.colors is None else 1.0
    bitmap = item.color_map.bitmap(item.color_map.texels[..., :3] * factor, skin.uv)
    return bitmap if skin.colors is None else product(bitmap, vertices)


def opacity(item: Material, skin: Skin) -> dict | float:
    """a: a number or a texture."""
    cutoff = item.json.get("alphaCutoff", 0.5) if item.alpha_mode == "MASK" else None
    value: dict | float = float(item.color[3])
    if skin.colors is not None:
        value = {"type": "mesh_attribute", "name": "vertex_alpha"}
    if item.color_map is not None:
        texels = item.color_map.texels[..., 3:]
        bitmap = item.color_map.bitmap(
            texels * value if isinstance(value, float) else texels, skin.uv
        )
        value = bitmap if isinstance(value, float) else product(bitmap, value)
    if cutoff is None:
        return value
    if isinstance(value, float):
        return float(value >= cutoff)
    use_plugins()
    return {"type": "gltf_cutoff", "nested": value, "cutoff": float(cutoff)}


def vertex_colors(item: Material, skin: Skin) -> dict[str, np.ndarray]:
    """The mesh's attributes: COLOR_0 times the factor."""
    if skin.colors is None:
        return {}
    values = skin.colors * item.color
    return {"vertex_color": values[:, :3], "vertex_alpha": values[:, 3:]}


def product(first: dict, second: dict) -> dict:
    """The product of two textures."""
    use_plugins()
    return {"type": "gltf_product", "first": first, "second": second}


def normals(item: Material, skin: Skin, side: int) -> dict:
    """The normal map, scaled, its green along n × t; turned around but for z if `side` is −1."""
    scale = side * item.json["normalTexture"].get("scale", 1.0)
    turn = np.array([scale, -scale if skin.mirrored else scale, 1.0])
    values = 0.5 + (item.normal_map.texels[..., :3] - 0.5) * turn
    return item.normal_map.bitmap(values, skin.uv)


def two_sided(item: Material, skin: Skin, front: dict) -> dict:
    """Mitsuba's surfaces reflect on their front only, ours on both sides.

    From behind, our normal is turned around; in Mitsuba's `twosided` it is mirrored at the surface.
    So the back gets a map of its own.
    """
    if item.normal_map is None:
        return {"type": "twosided", "nested": front}
    # Without Mitsuba's own remedies for normals that face away.
    bare = {"flip_invalid_normals": False, "use_shadowing_function": False}
    sides = {
        name: {"type": "normalmap", "normalmap": normals(item, skin, side), "nested": front, **bare}
        for name, side in (("a_front", 1), ("b_back", -1))
    }
    return {"type": "twosided", **sides}
