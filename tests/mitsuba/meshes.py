"""glTF primitives as triangles in world coordinates, as Mitsuba wants them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from gltf import Gltf, Unusable, normalized
from materials import OURS, Material, Skin, bsdf, emitter, material, vertex_colors

# Tangents that are further than this from the coordinates' own are worth a note, radians.
TANGENTS_DIFFER = 1e-2


@dataclass
class Mesh:
    """Triangles with a material; rows of three corners, float64, in the file's coordinates."""

    corners: np.ndarray
    normals: np.ndarray | None
    uv: np.ndarray | None
    bsdf: dict
    emitter: dict | None
    # Values at the corners, by the name under which Mitsuba looks for them.
    attributes: dict[str, np.ndarray] = field(default_factory=dict)


@dataclass
class Corners:
    """What a primitive has at the corners of its triangles, [triangle, corner, …]."""

    positions: np.ndarray
    normals: np.ndarray | None
    uv: np.ndarray | None
    # Only if there is a normal map.
    tangents: np.ndarray | None
    colors: np.ndarray | None
    # Which triangles have their bitangent along +v of the texture.
    mirrored: np.ndarray


def meshes(gltf: Gltf, primitive: dict, world: np.ndarray, model: str, notes: list[str]):
    """A primitive's meshes in world coordinates, and which models of `materials` they took.

    There are two if the texture is mirrored on a part of it: Mitsuba knows no handedness.
    """
    item = material(gltf, primitive.get("material"))
    positions, triangles = triangle_list(gltf, primitive)
    corners = place(gltf, primitive, world, (positions, triangles), item)
    smooth, result, used = corners.normals is not None, [], set()
    if smooth and any(item.emission):
        raise Unusable(f"{item.name}: an emitter with smooth normals (Mitsuba emits by those)")
    angle = 0.0 if item.normal_map is None else tangent_error(corners)
    parts = [False, True] if item.normal_map is not None else [None]
    for part in parts:
        some = slice(None) if part is None else corners.mirrored == part
        if not len(corners.positions[some]):
            continue
        own, uv, tangents, colors = (
            None if x is None else x[some]
            for x in (corners.normals, corners.uv, corners.tangents, corners.colors)
        )
        skin = Skin(lambda: is_closed(positions, triangles), colors, uv, bool(part))
        skin.smooth = smooth or angle > TANGENTS_DIFFER
        if colors is not None:
            skin.colors = colors.reshape(-1, 4)
        scattering, models = bsdf(item, skin, model)
        used |= models
        attributes = vertex_colors(item, skin)
        if tangents is not None:
            attributes["vertex_tangent"] = tangents.reshape(-1, 3)
        shape = (corners.positions[some], own, uv)
        result.append(Mesh(*shape, scattering, emitter(item, skin), attributes))
    if OURS not in used:
        if smooth:
            notes.append(f"{item.name}: smooth normals; Mitsuba does not ask the faces' too")
        if angle > TANGENTS_DIFFER:
            notes.append(f"{item.name}: tangents up to {math.degrees(angle):.0f}° off")
    return result, used


def triangle_list(gltf: Gltf, primitive: dict) -> tuple[np.ndarray, np.ndarray]:
    """A primitive's positions, float64, and the three indices of each triangle."""
    if primitive.get("mode", 4) != 4:
        raise Unusable(f"{gltf.path}: a primitive is no list of triangles")
    positions = gltf.read(primitive["attributes"]["POSITION"]).astype(float)
    indices = np.arange(len(positions))
    if "indices" in primitive:
        indices = gltf.read(primitive["indices"])[:, 0].astype(np.int64)
    return positions, indices[: len(indices) // 3 * 3].reshape(-1, 3)


def place(gltf: Gltf, primitive: dict, world: np.ndarray, shape: tuple, item: Material) -> Corners:
    """The triangles' corners in world coordinates, with all that the material asks for there.

    A mirroring transform turns triangles around, as glTF demands.  Without TANGENT, tangents are
    the texture coordinates' own, by face; Mitsuba knows no others.
    """
    (positions, triangles), (matrix, offset) = shape, (world[:3, :3], world[:3, 3])
    attributes, turned = primitive["attributes"], np.linalg.det(matrix) < 0
    if turned:
        triangles = triangles[:, [0, 2, 1]]
    corners = (positions @ matrix.T + offset)[triangles]
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    kept = np.linalg.norm(area, axis=1) > 0
    triangles, corners = triangles[kept], corners[kept]
    normals = uv = tangents = colors = None
    if "NORMAL" in attributes and not item.unlit:
        # det · M⁻ᵀ, which exists for flat transforms too; its sign does not matter here.
        a, b, c = matrix.T
        cofactor = np.column_stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)])
        normals = gltf.read(attributes["NORMAL"]).astype(float) @ cofactor.T
        normals = shading_normals(normals[triangles], normalized(area[kept]))
    mirrored = np.zeros(len(triangles), bool)
    if item.maps():
        name = f"TEXCOORD_{item.tex_coord()}"
        if name not in attributes:
            raise Unusable(f"{item.name}: textures on a mesh without {name}")
        uv = gltf.read(attributes[name]).astype(float)[triangles]
        # Coordinates as the normal map is met: one that is turned takes its axes along.
        own = uv if item.normal_map is None else uv @ item.normal_map.transform[:2, :2].T
        # The bitangent, n × t · w, points up in the picture, along −v.
        u, v = (own[:, i] - own[:, 0] for i in (1, 2))
        mirrored = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > 0
        if "TANGENT" in attributes:
            tangents = gltf.read(attributes["TANGENT"]).astype(float)[triangles]
            mirrored = (tangents[:, 0, 3] < 0) != turned
            tangents = tangents[..., :3] @ matrix.T
        elif item.normal_map is not None:
            tangents = uv_tangents(corners, own)
    if "COLOR_0" in attributes:
        colors = gltf.read(attributes["COLOR_0"]).astype(float)[triangles]
        if colors.shape[2] == 3:
            colors = np.concatenate([colors, np.ones_like(colors[..., :1])], axis=2)
    return Corners(corners, normals, uv, tangents, colors, mirrored)


def uv_tangents(corners: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Each face's ∂p/∂u, of any length, at its corners."""
    (e, f), (u, v) = ([x[:, i] - x[:, 0] for i in (1, 2)] for x in (corners, uv))
    det = u[:, :1] * v[:, 1:] - u[:, 1:] * v[:, :1]
    return np.repeat(((e * v[:, 1:] - f * u[:, 1:]) * np.sign(det))[:, None], 3, axis=1)


def tangent_error(corners: Corners) -> float:
    """The largest angle between a corner's tangent and its texture coordinates' own."""
    p, normals = corners.positions, corners.normals
    if normals is None:
        normals = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])[:, None]
    normals, both = normalized(normals), (uv_tangents(p, corners.uv), corners.tangents)
    flat = [x - normals * np.sum(x * normals, axis=-1, keepdims=True) for x in both]
    length = np.prod([np.linalg.norm(x, axis=-1) for x in flat], axis=0)
    cos = np.sum(flat[0] * flat[1], axis=-1)[length > 0] / length[length > 0]
    return float(np.arccos(np.clip(cos, -1, 1)).max(initial=0))


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
    if item.uv is not None:
        columns.append(item.uv.reshape(-1, 2))
        names += ["u", "v"]
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
