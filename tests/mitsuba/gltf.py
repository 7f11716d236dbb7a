"""Reads the part of glTF 2.0 that scenes for the comparison are made of.

Nodes are composed in float64, as the program composes them.  Nothing here knows a renderer.
"""

from __future__ import annotations

import base64
import binascii
import json
import struct
from pathlib import Path
from urllib.parse import unquote

import numpy as np

COMPONENTS = {
    5120: np.dtype("i1"),
    5121: np.dtype("u1"),
    5122: np.dtype("<i2"),
    5123: np.dtype("<u2"),
    5125: np.dtype("<u4"),
    5126: np.dtype("<f4"),
}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Unusable(Exception):
    """The input cannot be compared; the message is one line that says what and why."""


class Gltf:
    """A .glb or .gltf file with its buffers."""

    def __init__(self, path: Path):
        self.path = Path(path)
        try:
            data = self.path.read_bytes()
        except OSError as error:
            raise Unusable(f"{path}: cannot be read ({error.strerror})") from error
        try:
            text, blob = split_container(data)
            self.root = json.loads(text)
        except (ValueError, struct.error) as error:
            raise Unusable(f"{path}: not a glTF file") from error
        self.buffers = [
            self._buffer(item, blob if i == 0 else None)
            for i, item in enumerate(self.items("buffers"))
        ]

    def items(self, name: str) -> list:
        """One of the lists at the top of the file; empty if it is not there."""
        return self.root.get(name, [])

    def scene(self) -> dict:
        """The default scene."""
        scenes = self.items("scenes")
        if not scenes:
            raise Unusable(f"{self.path}: the file has no scene")
        return scenes[self.root.get("scene", 0)]

    def placed(self) -> list[tuple[dict, np.ndarray]]:
        """The default scene's nodes, in file order and depth first, with their world-from-node."""
        placed = []
        stack = [(index, np.eye(4)) for index in reversed(self.scene().get("nodes", []))]
        while stack:
            index, world_from_parent = stack.pop()
            node = self.items("nodes")[index]
            world_from_node = world_from_parent @ local_transform(node)
            stack.extend((child, world_from_node) for child in reversed(node.get("children", [])))
            placed.append((node, world_from_node))
        return placed

    def read(self, index: int) -> np.ndarray:
        """The elements of an accessor, a row each; normalised integers as numbers up to 1."""
        accessor = self.items("accessors")[index]
        if "sparse" in accessor or "bufferView" not in accessor:
            raise Unusable(f"{self.path}: accessor {index} is sparse or empty")
        view = self.items("bufferViews")[accessor["bufferView"]]
        dtype, width = COMPONENTS.get(accessor["componentType"]), WIDTHS.get(accessor["type"])
        if dtype is None or width is None:
            raise Unusable(
                f"{self.path}: accessor {index} is of a type that no triangle mesh needs"
            )
        size = dtype.itemsize * width
        try:
            rows = np.ndarray(
                (accessor["count"], width),
                dtype,
                self.buffers[view["buffer"]],
                view.get("byteOffset", 0) + accessor.get("byteOffset", 0),
                (view.get("byteStride", size), dtype.itemsize),
            )
        except (TypeError, ValueError) as error:
            raise Unusable(f"{self.path}: accessor {index} reaches beyond its buffer") from error
        if not accessor.get("normalized") or dtype.kind == "f":
            return rows
        return np.maximum(rows / np.iinfo(dtype).max, -1.0)

    def image(self, index: int) -> bytes:
        """The file of an image, PNG or JPEG."""
        item = self.items("images")[index]
        if "bufferView" in item:
            view = self.items("bufferViews")[item["bufferView"]]
            start = view.get("byteOffset", 0)
            return bytes(self.buffers[view["buffer"]][start : start + view["byteLength"]])
        return self._file(item["uri"], f"image {index}")

    def _buffer(self, item: dict, blob: bytes | None) -> bytes:
        uri = item.get("uri")
        if uri is None:
            if blob is None:
                raise Unusable(f"{self.path}: a buffer has neither a file nor a chunk")
            return blob
        return self._file(uri, "the buffer")

    def _file(self, uri: str, what: str) -> bytes:
        try:
            if uri.startswith("data:"):
                return base64.b64decode(uri.partition(",")[2], validate=True)
            return (self.path.parent / unquote(uri)).read_bytes()
        except (OSError, binascii.Error) as error:
            raise Unusable(f"{self.path}: {what} '{uri[:60]}' cannot be read") from error


def split_container(data: bytes) -> tuple[bytes, bytes | None]:
    """The JSON and, of a .glb, the binary chunk."""
    if data[:4] != b"glTF":
        return data, None
    chunks, at = {}, 12
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<I4s", data, at)
        chunks.setdefault(kind, data[at + 8 : at + 8 + length])
        at += 8 + (length + 3) // 4 * 4
    return chunks.get(b"JSON", b""), chunks.get(b"BIN\0")


def local_transform(node: dict) -> np.ndarray:
    """A node's own 4×4 matrix."""
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = normalized(node.get("rotation", [0, 0, 0, 1]))
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * np.array(node.get("scale", [1, 1, 1]), float)
    matrix[:3, 3] = node.get("translation", [0, 0, 0])
    return matrix


def normalized(v) -> np.ndarray:
    """The vector, or each row, at length 1."""
    v = np.asarray(v, float)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)
