"""glTF materials as Mitsuba BSDFs and emission; the table in `scene.py` lists them."""

from __future__ import annotations

from gltf import Unusable

# Below this roughness a surface is a Dirac.
SMOOTH = 0.03


def rgb(value) -> dict:
    """A colour, or a radiometric quantity per channel."""
    return {"type": "rgb", "value": [float(x) for x in value]}


def extension(item: dict, name: str) -> dict:
    """A material's extension, empty if it is not there."""
    return item.get("extensions", {}).get(f"KHR_materials_{name}", {})


def emitted(material: dict, name: str) -> list[float]:
    """L_e, W m⁻² sr⁻¹."""
    strength = extension(material, "emissive_strength").get("emissiveStrength", 1.0)
    emission = [max(0.0, x * strength) for x in material.get("emissiveFactor", [0, 0, 0])]
    if any(emission) and material.get("doubleSided"):
        raise Unusable(f"{name}: a double-sided emitter (Mitsuba's emit to one side)")
    return emission


def bsdf(material: dict, name: str, closed) -> dict:
    """How a material scatters; `closed` (asked of glass) tells if its mesh encloses a volume."""
    pbr, specular = material.get("pbrMetallicRoughness", {}), extension(material, "specular")
    if any(
        key.endswith("Texture")
        for part in [material, pbr, *material.get("extensions", {}).values()]
        for key in part
    ):
        raise Unusable(f"{name}: textures")
    if material.get("alphaMode", "OPAQUE") != "OPAQUE":
        raise Unusable(f"{name}: transparency by alpha")
    color = [min(1.0, max(0.0, x)) for x in pbr.get("baseColorFactor", [1, 1, 1, 1])[:3]]
    metallic, roughness = pbr.get("metallicFactor", 1.0), pbr.get("roughnessFactor", 1.0)
    transmission = extension(material, "transmission").get("transmissionFactor", 0.0)
    if metallic == 1 and roughness < SMOOTH:
        if min(color) < 1:
            raise Unusable(
                f"{name}: a mirror of F0 {color} (Mitsuba has no Schlick term: only 1 is mapped)"
            )
        return two_sided({"type": "conductor", "material": "none"})
    if metallic == 0 and transmission == 1 and roughness < SMOOTH and not specular:
        volume = extension(material, "volume")
        if "attenuationColor" in volume and min(volume["attenuationColor"]) < 1:
            raise Unusable(f"{name}: absorption inside glass")
        solid = volume.get("thicknessFactor", 0) > 0 or closed()
        kind, ior = "dielectric" if solid else "thindielectric", extension(material, "ior").get(
            "ior", 1.5
        )
        return {"type": kind, "int_ior": ior, "ext_ior": 1.0, "specular_transmittance": rgb(color)}
    if metallic == 0 and transmission == 0 and specular.get("specularFactor", 1.0) == 0:
        return two_sided({"type": "diffuse", "reflectance": rgb(color)})
    raise Unusable(
        f"{name}: neither Lambert (metallic 0, specularFactor 0) nor a mirror nor clear glass"
    )


def two_sided(scattering: dict) -> dict:
    """Mitsuba's surfaces reflect on their front only, ours on both sides."""
    return {"type": "twosided", "nested": scattering}
