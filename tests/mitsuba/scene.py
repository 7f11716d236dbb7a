"""Our glTF scenes as Mitsuba 3 scenes.

here                                                Mitsuba
--------------------------------------------------  -----------------------------------------
Lambert: metallic 0, KHR_materials_specular 0       `twosided` `diffuse`
mirror: metallic 1, roughness < 0.03, F₀ = 1        `twosided` `conductor`, material `none`
glass: transmission 1, roughness < 0.03             `dielectric` (a closed mesh or a thickness)
                                                    or `thindielectric`, in vacuum
emission, W m⁻² sr⁻¹, from the front face           `area`, with the normals of the faces
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

from gltf import Gltf, Unusable, normalized
from materials import bsdf, emitted, rgb

mi.set_variant("scalar_rgb")

KNOWN_EXTENSIONS = {
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
}
# A spot's edge is hard if it is narrower than this share of the angle.
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
    unknown = set(gltf.items("extensionsUsed")) - KNOWN_EXTENSIONS
    if unknown:
        raise Unusable(f"{gltf.path}: no mapping for the extension {sorted(unknown)[0]}")
    scene, placed = Scene(), gltf.placed()
    for node, world in placed:
        if "mesh" in node:
            for primitive in gltf.items("meshes")[node["mesh"]]["primitives"]:
                scene.meshes.append(mesh(gltf, primitive, world, scene.notes))
    scene.meshes = [item for item in scene.meshes if len(item.corners)]
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
    if not scene.emitters and not any(any(m.emission) for m in scene.meshes):
        raise Unusable(f"{gltf.path}: nothing emits (the program's own lamp is its own affair)")
    return scene


def to_mitsuba(scene: Scene, folder: Path, size: tuple[int, int], max_edges: int) -> dict:
    """The scene for `mi.load_dict`; meshes are written into `folder`, to last until then."""
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


def mesh(gltf: Gltf, primitive: dict, world: np.ndarray, notes: list[str]) -> Mesh:
    """A primitive in world coordinates with its material."""
    index = primitive.get("material")
    material = gltf.items("materials")[index] if index is not None else {}
    name = f"{gltf.path}: material {material.get('name', index)!r}"
    positions, triangles = triangle_list(gltf, primitive)
    corners, normals = place(gltf, primitive, world, positions, triangles)
    emission = emitted(material, name)
    if normals is not None:
        notes.append(f"{name}: smooth normals; silhouettes may differ a little, see `place`")
        if any(emission):
            raise Unusable(f"{name}: an emitter with smooth normals (Mitsuba emits about those)")
    scattering = bsdf(material, name, lambda: is_closed(positions, triangles))
    return Mesh(corners, normals, scattering, emission)


def triangle_list(gltf: Gltf, primitive: dict) -> tuple[np.ndarray, np.ndarray]:
    """A primitive's positions, float64, and the three indices of each triangle."""
    if primitive.get("mode", 4) != 4:
        raise Unusable(f"{gltf.path}: a primitive is no list of triangles")
    positions = gltf.read(primitive["attributes"]["POSITION"]).astype(float)
    indices = np.arange(len(positions))
    if "indices" in primitive:
        indices = gltf.read(primitive["indices"])[:, 0].astype(np.int64)
    return positions, indices[: len(indices) // 3 * 3].reshape(-1, 3)


def place(gltf: Gltf, primitive: dict, world: np.ndarray, positions, triangles):
    """The triangles' corners in world coordinates, and the normals there if they are not flat.

    A mirroring transform turns triangles around, as glTF demands.  Where a smooth normal and the
    face disagree on the side of a direction, the program scatters nothing; Mitsuba asks the normal
    alone.
    """
    matrix, offset = world[:3, :3], world[:3, 3]
    if np.linalg.det(matrix) < 0:
        triangles = triangles[:, [0, 2, 1]]
    corners = (positions @ matrix.T + offset)[triangles]
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    kept = np.linalg.norm(area, axis=1) > 0
    if "NORMAL" not in primitive["attributes"]:
        return corners[kept], None
    # det · M⁻ᵀ, which exists for flat transforms too; its sign does not matter here.
    a, b, c = matrix.T
    cofactor = np.column_stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)])
    normals = gltf.read(primitive["attributes"]["NORMAL"]).astype(float) @ cofactor.T
    return corners[kept], shading_normals(normals[triangles[kept]], normalized(area[kept]))


def shading_normals(normals: np.ndarray, face: np.ndarray) -> np.ndarray | None:
    """The corners' normals, turned to the side of the face; None if they are the faces' own."""
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    face = np.broadcast_to(face[:, None], normals.shape)
    normals = np.where(length > 0, normals / np.where(length > 0, length, 1), face)
    cos = np.sum(normals * face, axis=-1, keepdims=True)
    normals = np.where(np.abs(cos) < 1e-4, face, normals * np.sign(cos))
    return normals if np.abs(normals - face).max(initial=0) > 5e-6 else None


def is_closed(positions: np.ndarray, triangles: np.ndarray) -> bool:
    """Is every edge shared by two triangles that run along it in opposite directions?"""
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
    return np.array(
        bitmap.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False), float
    )


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
