"""Writes small .glb files, and the pictures that go with them."""

from __future__ import annotations

import json
import math
import struct
import zlib
from pathlib import Path

import numpy as np

INDEX_TYPES = {5121: "u1", 5123: "<u2", 5125: "<u4"}
KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class Glb:
    """A .glb in the making."""

    def __init__(self):
        self.lists = {
            name: []
            for name in (
                *("nodes", "meshes", "materials", "cameras", "accessors", "bufferViews"),
                *("images", "samplers", "textures"),
            )
        }
        self.roots, self.lights, self.extras, self.data = [], [], {}, b""
        self.used = set()

    def push(self, name: str, item: dict) -> int:
        """Appends to a list; the index there."""
        self.lists[name].append(item)
        return len(self.lists[name]) - 1

    def node(self, parent: int | None = None, **item) -> int:
        """Adds a node below `parent`, or at the top."""
        index = self.push("nodes", item)
        siblings = (
            self.roots if parent is None else self.lists["nodes"][parent].setdefault("children", [])
        )
        siblings.append(index)
        return index

    def material(self, albedo: list[float], emission: list[float] | None = None) -> int:
        """A Lambert material that may emit, W m⁻² sr⁻¹."""
        extensions = {"KHR_materials_specular": {"specularFactor": 0}}
        item = {
            "pbrMetallicRoughness": {"baseColorFactor": [*albedo, 1], "metallicFactor": 0},
            "extensions": extensions,
        }
        if emission:
            strength = max(emission)
            item["emissiveFactor"] = [x / strength for x in emission]
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        return self.push("materials", item)

    def texture(self, texels: np.ndarray, wraps=(10497, 10497)) -> dict:
        """A reference to a new texture, [y, x, channel] of 8 bits."""
        sampler = self.push("samplers", {"wrapS": wraps[0], "wrapT": wraps[1]})
        image = {"bufferView": self.view(png(texels)), "mimeType": "image/png"}
        item = {"source": self.push("images", image), "sampler": sampler}
        return {"index": self.push("textures", item)}

    def transformed(self, texture: dict, **transform) -> dict:
        """The same with KHR_texture_transform."""
        self.used.add("KHR_texture_transform")
        return {**texture, "extensions": {"KHR_texture_transform": transform}}

    def mesh(self, quads: list, material: int, index_type: int = 5123, **attributes) -> int:
        """Quads whose front is where their corners run counter-clockwise.

        Attributes have a row for each corner, or one for all.
        """
        corners = np.array(quads, "<f4").reshape(-1, 3)
        indices = np.array(
            [4 * i + k for i in range(len(quads)) for k in (0, 1, 2, 0, 2, 3)],
            INDEX_TYPES[index_type],
        )
        limits = {"min": corners.min(axis=0).tolist(), "max": corners.max(axis=0).tolist()}
        position = self.accessor(corners, 5126, "VEC3", **limits)
        triangles = self.accessor(indices, index_type, "SCALAR")
        more = {}
        for name, values in attributes.items():
            rows = np.array(values, "<f4").reshape(-1, np.shape(values)[-1])
            rows = np.broadcast_to(rows, (len(corners), rows.shape[1])) if len(rows) == 1 else rows
            more[name] = self.accessor(rows, 5126, KINDS[rows.shape[1]])
        primitive = {
            "attributes": {"POSITION": position, **more},
            "indices": triangles,
            "material": material,
        }
        return self.push("meshes", {"primitives": [primitive]})

    def accessor(self, values: np.ndarray, component: int, kind: str, **more) -> int:
        """Adds values with their view."""
        view = self.view(values.tobytes())
        item = {
            "bufferView": view,
            "componentType": component,
            "count": len(values),
            "type": kind,
            **more,
        }
        return self.push("accessors", item)

    def view(self, data: bytes) -> int:
        """Adds bytes with their view."""
        item = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.data += data + bytes(-len(data) % 4)
        return self.push("bufferViews", item)

    def light(self, light: dict, parent: int | None = None, **placing) -> int:
        """A light of KHR_lights_punctual on a node."""
        self.lights.append(light)
        extension = {"KHR_lights_punctual": {"light": len(self.lights) - 1}}
        return self.node(parent, extensions=extension, **placing)

    def camera(self, position, target, yfov: float, lens: dict | None = None) -> int:
        """A camera that looks from one point to another, +Y up; its node has a matrix."""
        item = {
            "type": "perspective",
            "perspective": {"yfov": yfov, "znear": 0.01},
            **({"extras": lens} if lens else {}),
        }
        return self.node(camera=self.push("cameras", item), matrix=looking(position, target))

    def write(self, path: Path) -> None:
        """Writes the file."""
        root = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": self.roots, "extras": self.extras}],
        }
        root.update({name: items for name, items in self.lists.items() if items})
        root["buffers"] = [{"byteLength": len(self.data)}]
        used = set(self.used)
        used.update(*(material.get("extensions", {}) for material in self.lists["materials"]))
        if self.lights:
            root["extensions"] = {"KHR_lights_punctual": {"lights": self.lights}}
            used.add("KHR_lights_punctual")
        root["extensionsUsed"] = sorted(used)
        text = json.dumps(root).encode()
        path.write_bytes(container(text, self.data))


def container(text: bytes, data: bytes) -> bytes:
    """A .glb file of its two parts."""
    chunks = [(b"JSON", text + b" " * (-len(text) % 4)), (b"BIN\0", data + bytes(-len(data) % 4))]
    body = b"".join(struct.pack("<I4s", len(data), kind) + data for kind, data in chunks)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def packed(path: Path) -> tuple[dict, bytearray]:
    """A .gltf file's JSON and one buffer that also holds the files beside it."""
    root, data, starts = json.loads(path.read_text()), bytearray(), []
    for item in root.get("buffers", []):
        starts.append(len(data))
        data.extend((path.parent / item["uri"]).read_bytes())
        data.extend(bytes(-len(data) % 4))
    for view in root["bufferViews"]:
        view["byteOffset"] = view.get("byteOffset", 0) + starts[view["buffer"]]
        view["buffer"] = 0
    for item in root.get("images", []):
        file = path.parent / item.pop("uri")
        view = {"buffer": 0, "byteOffset": len(data), "byteLength": file.stat().st_size}
        root["bufferViews"].append(view)
        item["bufferView"] = len(root["bufferViews"]) - 1
        item["mimeType"] = "image/png" if file.suffix == ".png" else "image/jpeg"
        data.extend(file.read_bytes())
        data.extend(bytes(-len(data) % 4))
    return root, data


def looking(position, target) -> list[float]:
    """A node's matrix, column by column, whose −Z points from one point to another."""
    position, target = np.array(position, float), np.array(target, float)
    back = (position - target) / np.linalg.norm(position - target)
    right = np.cross([0, 1, 0] if abs(back[1]) < 0.99 else [0, 0, -1], back)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([right, np.cross(back, right), back, position])
    return matrix.T.reshape(-1).tolist()


def turn(degrees: float) -> list[float]:
    """A rotation about +Y."""
    half = math.radians(degrees) / 2
    return [0, math.sin(half), 0, math.cos(half)]


def cube() -> list:
    """The cube from −1 to 1, front outwards."""
    quads = []
    for axis in range(3):
        for sign in (1, -1):
            n, u, v = np.zeros(3), np.zeros(3), np.zeros(3)
            n[axis], u[(axis + 1) % 3], v[(axis + 2) % 3] = sign, sign, 1
            quads.append([n - u - v, n + u - v, n + u + v, n - u + v])
    return quads


def write_hdr(path: Path, picture: np.ndarray) -> None:
    """Writes Radiance's RGBE, not compressed: (mantissa / 256) · 2^(exponent − 128)."""
    exponent = np.frexp(picture.max(axis=-1))[1]
    mantissa = np.clip(np.floor(picture * np.exp2(8 - exponent)[..., None]), 0, 255)
    texels = np.concatenate([mantissa, exponent[..., None] + 128], axis=-1).astype(np.uint8)
    height, width = picture.shape[:2]
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    path.write_bytes(header.encode() + texels.tobytes())


def png(texels: np.ndarray) -> bytes:
    """A PNG file of 8 bits: grey, RGB or RGBA, [y, x, channel]."""
    height, width, channels = texels.shape
    kind = {1: 0, 3: 2, 4: 6}[channels]
    rows = np.concatenate([np.zeros((height, 1), "u1"), texels.reshape(height, -1)], axis=1)
    chunks = [
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)),
        (b"IDAT", zlib.compress(rows.astype("u1").tobytes())),
        (b"IEND", b""),
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks
    )
