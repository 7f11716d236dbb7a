"""Our glTF scenes as Mitsuba 3 scenes.

| here | Mitsuba |
|---|---|
| Lambert: metallic 0, KHR_materials_specular factor 0 | `twosided` `diffuse` |
| mirror: metallic 1, roughness < 0.03, F₀ = base colour = 1 | `twosided` `conductor`, material `none` |
| glass: transmission 1, roughness < 0.03 | `dielectric` if the mesh is closed, else `thindielectric`; outside index 1, not Mitsuba's air |
| emission, W m⁻² sr⁻¹, front face only | `area`; normals of the faces, because Mitsuba emits to the side of the shading normal |
| KHR_lights_punctual point, directional | `point`, `directional` |
| spot with a hard edge (inner angle ≈ outer angle) | `spot` |
| camera; extras lensRadius, focusDistance | `perspective`; `thinlens` (both measure the focus distance along the axis) |
| scene extras environment, environmentRotation | `constant`, or `envmap` on a finer lattice, see `environment` |
| K, edges of a path | `max_depth` |

What is not in the table is refused: `Unusable` names it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import mitsuba as mi
import numpy as np

from gltf import Gltf, Unusable, normalized

SMOOTH = 0.03
KNOWN_EXTENSIONS = {
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
}
# A spot whose edge is wider than this, relative to the angle, is not hard: Mitsuba's edge has another shape.
HARD_EDGE = 1e-3


@dataclass
class Mesh:
    """Triangles with a material; rows of three corners, float64, in the file's coordinates."""

    corners: np.ndarray
    normals: np.ndarray | None
    bsdf: dict
    emission: list[float]


@dataclass
class Scene:
    """A glTF scene, ready to become a Mitsuba scene of any size."""

    meshes: list[Mesh] = field(default_factory=list)
    emitters: list[dict] = field(default_factory=list)
    camera: dict = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))
    extent: float = 1.0


def load(path: Path) -> Scene:
    """Reads a scene and maps everything that does not depend on the size of the picture."""
    try:
        return _load(Gltf(path))
    except (KeyError, IndexError, TypeError, AttributeError) as error:
        raise Unusable(
            f"{path}: not a valid glTF file ({type(error).__name__}: {error})"
        ) from error


def _load(gltf: Gltf) -> Scene:
    unknown = set(gltf.list("extensionsUsed")) - KNOWN_EXTENSIONS
    if unknown:
        raise Unusable(f"{gltf.path}: no mapping for the extension {sorted(unknown)[0]}")
    scene, placed = Scene(), gltf.placed()
    for node, world in placed:
        if "mesh" in node:
            for primitive in gltf.list("meshes")[node["mesh"]]["primitives"]:
                scene.meshes.append(mesh(gltf, primitive, world, scene.notes))
    if not scene.meshes:
        raise Unusable(f"{gltf.path}: the scene has no triangles")
    corners = np.concatenate([m.corners.reshape(-1, 3) for m in scene.meshes])
    low, high = corners.min(axis=0), corners.max(axis=0)
    # Mitsuba computes in f32 and offsets rays by a multiple of the largest coordinate: it gets the scene around its origin.
    scene.origin, scene.extent = 0.5 * (low + high), float(np.linalg.norm(high - low))
    for node, world in placed:
        index = node.get("extensions", {}).get("KHR_lights_punctual", {}).get("light")
        if index is not None:
            light = gltf.root["extensions"]["KHR_lights_punctual"]["lights"][index]
            scene.emitters.append(punctual(light, world, scene, f"{gltf.path}: light {index}"))
        if "camera" in node and not scene.camera:
            scene.camera = camera(
                gltf.list("cameras")[node["camera"]],
                world,
                scene,
                f"{gltf.path}: camera {node['camera']}",
            )
    scene.emitters += environment(gltf)
    if not scene.camera:
        raise Unusable(
            f"{gltf.path}: there is no perspective camera, and where the program would put one is its own affair"
        )
    if not scene.emitters and not any(any(m.emission) for m in scene.meshes):
        raise Unusable(
            f"{gltf.path}: nothing emits, and the lamp the program would add is its own affair"
        )
    return scene


def to_mitsuba(scene: Scene, folder: Path, size: tuple[int, int], max_edges: int) -> dict:
    """The scene as a dictionary for `mi.load_dict`; meshes are written into `folder`, which must live until then."""
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
        # A roulette that begins beyond the last edge: none.
        "integrator": {"type": "path", "max_depth": max_edges, "rr_depth": max_edges + 1},
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
        if any(item.emission):
            shape["emitter"] = {"type": "area", "radiance": rgb(item.emission)}
        result[f"mesh{i}"] = shape
    result.update({f"emitter{i}": emitter for i, emitter in enumerate(scene.emitters)})
    return result


def rgb(value) -> dict:
    """A colour, or a radiometric quantity per channel."""
    return {"type": "rgb", "value": [float(x) for x in value]}


def mesh(gltf: Gltf, primitive: dict, world: np.ndarray, notes: list[str]) -> Mesh:
    """A primitive in world coordinates; a mirroring transform turns its triangles around, as glTF demands."""
    if primitive.get("mode", 4) != 4:
        raise Unusable(
            f"{gltf.path}: only lists of triangles can be mapped, no strips, fans, lines or points"
        )
    attributes = primitive["attributes"]
    positions = gltf.read(attributes["POSITION"]).astype(float)
    indices = (
        gltf.read(primitive["indices"])[:, 0]
        if "indices" in primitive
        else np.arange(len(positions))
    )
    triangles = indices[: len(indices) // 3 * 3].astype(np.int64).reshape(-1, 3)
    matrix, offset = world[:3, :3], world[:3, 3]
    placed = triangles[:, [0, 2, 1]] if np.linalg.det(matrix) < 0 else triangles
    corners = (positions @ matrix.T + offset)[placed]
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    kept = np.linalg.norm(area, axis=1) > 0
    corners, face = corners[kept], normalized(area[kept])
    index = primitive.get("material")
    material = gltf.list("materials")[index] if index is not None else {}
    name = f"{gltf.path}: material {material.get('name', index)!r}"
    emission = emitted(material, name)
    normals = None
    if "NORMAL" in attributes:
        cofactor = np.stack(
            [np.cross(matrix[:, (i + 1) % 3], matrix[:, (i + 2) % 3]) for i in range(3)], axis=1
        )
        normals = shading_normals(
            (gltf.read(attributes["NORMAL"]).astype(float) @ cofactor.T)[placed[kept]], face
        )
    if normals is not None:
        notes.append(
            f"{name}: smooth normals; Mitsuba does not check the side of the face, so silhouettes may differ a little"
        )
        if any(emission):
            raise Unusable(
                f"{name}: an emitter with smooth normals (Mitsuba emits to the side of those)"
            )
    return Mesh(
        corners, normals, bsdf(material, name, lambda: is_closed(positions, triangles)), emission
    )


def shading_normals(normals: np.ndarray, face: np.ndarray) -> np.ndarray | None:
    """The corners' normals on the side of the face, as the program takes them; None if they are those of the faces."""
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    face = np.broadcast_to(face[:, None], normals.shape)
    normals = np.where(length > 0, normals / np.where(length > 0, length, 1), face)
    cos = np.sum(normals * face, axis=-1, keepdims=True)
    normals = np.where(np.abs(cos) < 1e-4, face, normals * np.sign(cos))
    return normals if np.abs(normals - face).max(initial=0) > 5e-6 else None


def is_closed(positions: np.ndarray, triangles: np.ndarray) -> bool:
    """Is every edge shared by two triangles that run along it in opposite directions, once equal positions are one?"""
    weld = np.unique(positions + 0.0, axis=0, return_inverse=True)[1].reshape(-1)
    edges = [
        (t[i], t[(i + 1) % 3])
        for t in weld[triangles].tolist()
        if len(set(t)) == 3
        for i in range(3)
    ]
    known = set(edges)
    return bool(edges) and len(known) == len(edges) and all((b, a) in known for a, b in edges)


def ply(item: Mesh, origin: np.ndarray) -> bytes:
    """A binary PLY file around `origin`; triangles share no vertices."""
    columns = [(item.corners - origin).reshape(-1, 3)]
    names = ["x", "y", "z"]
    if item.normals is not None:
        columns.append(item.normals.reshape(-1, 3))
        names += ["nx", "ny", "nz"]
    count = len(item.corners)
    faces = np.zeros(count, [("n", "u1"), ("i", "<i4", 3)])
    faces["n"], faces["i"] = 3, np.arange(3 * count).reshape(-1, 3)
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {3 * count}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {count}", "property list uchar int vertex_indices", "end_header", ""]
    return (
        "\n".join(header).encode()
        + np.concatenate(columns, axis=1).astype("<f4").tobytes()
        + faces.tobytes()
    )


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
    """How a material scatters; `closed` tells whether the mesh encloses a volume (asked of glass only)."""
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
                f"{name}: a mirror of F0 {color}: Mitsuba has no Schlick term, so only F0 = 1 can be compared"
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
        f"{name}: neither Lambert (metallic 0, specularFactor 0) nor a mirror of F0 = 1 nor clear glass"
    )


def two_sided(scattering: dict) -> dict:
    """Mitsuba's surfaces reflect on their front only, ours on both sides."""
    return {"type": "twosided", "nested": scattering}


def punctual(light: dict, world: np.ndarray, scene: Scene, name: str) -> dict:
    """A light of KHR_lights_punctual: W sr⁻¹ or, directional, W m⁻²; it shines along the node's −Z."""
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
            f"{name}: a spot with a soft edge (only innerConeAngle ≈ outerConeAngle can be compared)"
        )
    # Across the edge glTF's factor is a square (mean 1/3), Mitsuba's is linear (mean 1/2): 2/3 of the width carries the same.
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
    """Local +Z along `axis`, local +Y towards `up`; local +X then is the picture's left, as Mitsuba has it."""
    axis = normalized(axis)
    up = normalized(up - axis * np.dot(up, axis))
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([np.cross(up, axis), up, axis, position])
    return mi.ScalarTransform4f(matrix)


def environment(gltf: Gltf) -> list[dict]:
    """The scene's surroundings: constant, or an equirectangular map whose centre is −Z and whose top is +Y.

    Our texel centres lie at ((i + ½)/W, (j + ½)/H), bilinear between them, u wraps, v clamps.  Mitsuba's rows lie at
    v = 0 … 1, its columns at u = (i + s)/W with s = ½ or, in older versions, 0.  The map is handed over on a lattice that
    contains all our knots, so both are the same function.  Our u = ½ is Mitsuba's u = 0: half a turn.
    """
    extras = gltf.scene().get("extras") or {}
    value = extras.get("environment")
    if value is None:
        return []
    if not isinstance(value, str):
        return [{"type": "constant", "radiance": rgb(value)}] if any(value) else []
    file = gltf.path.parent / value
    try:
        bitmap = mi.Bitmap(str(file)).convert(
            mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False
        )
    except RuntimeError as error:
        raise Unusable(f"{gltf.path}: the environment '{file}' cannot be read") from error
    texels, shift = np.array(bitmap), column_shift()
    height, width = texels.shape[:2]
    fine = np.arange(width) + 0.5 if shift else np.arange(2 * width) / 2
    fine = interpolated(texels, fine - 0.5, np.arange(2 * height + 1) / 2 - 0.5)
    turn = mi.ScalarTransform4f().rotate([0, 1, 0], 180 + extras.get("environmentRotation", 0.0))
    return [{"type": "envmap", "bitmap": mi.Bitmap(fine.astype(np.float32)), "to_world": turn}]


def interpolated(texels: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Our interpolant at the lattice of `x` and `y`, in texels from the centre of the first one."""
    height, width = texels.shape[:2]
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = (x - left)[None, :, None], (y - top)[:, None, None]
    rows = [np.clip(top + i, 0, height - 1) for i in (0, 1)]
    cols = [(left + i) % width for i in (0, 1)]
    upper, lower = ((1 - fx) * texels[r][:, cols[0]] + fx * texels[r][:, cols[1]] for r in rows)
    return (1 - fy) * upper + fy * lower


def column_shift() -> float:
    """Where Mitsuba puts the centre of an environment map's first column, in columns: ½, or 0 in older versions."""
    texels = np.zeros((3, 4, 3), np.float32)
    texels[:, 0] = 1
    emitter = mi.load_dict({"type": "envmap", "bitmap": mi.Bitmap(texels)})
    at = mi.SurfaceInteraction3f()
    at.wi = mi.Vector3f(0, 0, 1)
    return 0.5 if emitter.eval(at)[0] < 0.75 else 0.0
