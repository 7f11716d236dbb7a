"""glTF textures as Mitsuba's `bitmap`.

Both put the centre of texel (i, j) at ((i + ½)/W, (j + ½)/H), with v downwards, and interpolate
linear values bilinearly, whatever filter the sampler names.  Mitsuba would store pictures of eight
bits as 16-bit floats, so it gets float32.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import mitsuba as mi
import numpy as np

from gltf import Gltf, Unusable

WRAPS = {10497: "repeat", 33071: "clamp", 33648: "mirror"}
# Where the wrap modes of the two axes differ, Mitsuba gets a picture of all the tiles in use; the
# most numbers in it.
MOST_TILED = 1 << 26


@dataclass
class Texture:
    """Texels, [y, x, RGBA], linear, and how they are looked up."""

    name: str
    texels: np.ndarray
    wraps: tuple[str, str]
    # From the mesh's coordinates to the texture's, 3×3.
    transform: np.ndarray
    tex_coord: int

    def bitmap(self, values: np.ndarray, uv: np.ndarray) -> dict:
        """Mitsuba's texture with other values in place of the texels; `uv` are those in use."""
        transform, wrap = self.transform, self.wraps[0]
        if self.wraps[0] != self.wraps[1]:
            values, transform, wrap = self._tiled(values, uv)
        # Mitsuba wants two texels each way; a single one is the same as two alike.
        for axis in (0, 1):
            if values.shape[axis] == 1:
                values = np.repeat(values, 2, axis)
        return {
            "type": "bitmap",
            "bitmap": mi.Bitmap(np.ascontiguousarray(values, np.float32)),
            "raw": True,
            "wrap_mode": wrap,
            "to_uv": mi.ScalarTransform3f(transform),
        }

    def _tiled(self, values: np.ndarray, uv: np.ndarray):
        """All the tiles in use as one picture, for axes that wrap differently."""
        at = uv.reshape(-1, 2) @ self.transform[:2, :2].T + self.transform[:2, 2]
        # The interpolation asks half a texel further.
        low, high = np.floor(at.min(axis=0) - 0.5), np.ceil(at.max(axis=0) + 0.5)
        if np.prod(high - low) * values.size > MOST_TILED:
            raise Unusable(f"{self.name}: different wrap modes over too many tiles")
        for axis, wrap, first, last in zip((1, 0), self.wraps, low, high):
            n = values.shape[axis]
            places = np.arange(int(first) * n, int(last) * n)
            values = np.take(values, wrapped(places, n, wrap), axis)
        shrink = np.diag([*1 / (high - low), 1.0])
        shrink[:2, 2] = -low / (high - low)
        return values, shrink @ self.transform, "clamp"


def wrapped(i: np.ndarray, n: int, mode: str) -> np.ndarray:
    """The texel, of n, that an index means."""
    if mode == "clamp":
        return np.clip(i, 0, n - 1)
    if mode == "repeat":
        return i % n
    i = i % (2 * n)
    return np.where(i < n, i, 2 * n - 1 - i)


def texture(gltf: Gltf, reference: dict | None, color: bool, name: str) -> Texture | None:
    """The texture that a material refers to; `color`: its RGB is sRGB."""
    if reference is None:
        return None
    item = gltf.items("textures")[reference["index"]]
    if "source" not in item:
        raise Unusable(f"{name}: a texture without a PNG or JPEG picture")
    sampler = gltf.items("samplers")[item["sampler"]] if "sampler" in item else {}
    moved = reference.get("extensions", {}).get("KHR_texture_transform", {})
    return Texture(
        name,
        texels(gltf.image(item["source"]), color, f"{name}: image {item['source']}"),
        tuple(WRAPS[sampler.get(key, 10497)] for key in ("wrapS", "wrapT")),
        uv_transform(moved),
        moved.get("texCoord", reference.get("texCoord", 0)),
    )


def uv_transform(moved: dict) -> np.ndarray:
    """KHR_texture_transform: scaled, then turned counter-clockwise as seen with v up, then moved."""
    angle, (sx, sy) = moved.get("rotation", 0.0), moved.get("scale", [1, 1])
    (x, y), c, s = moved.get("offset", [0, 0]), math.cos(angle), math.sin(angle)
    return np.array([[c * sx, s * sy, x], [-s * sx, c * sy, y], [0, 0, 1]], float)


def texels(data: bytes, color: bool, name: str) -> np.ndarray:
    """A picture's texels, [y, x, RGBA], linear."""
    stream = mi.MemoryStream()
    stream.write(data)
    stream.seek(0)
    try:
        bitmap = mi.Bitmap(stream)
    except RuntimeError as error:
        raise Unusable(f"{name} cannot be read") from error
    bitmap.set_srgb_gamma(color)
    return np.array(bitmap.convert(mi.Bitmap.PixelFormat.RGBA, mi.Struct.Type.Float32, False))
