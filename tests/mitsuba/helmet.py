#!/usr/bin/env python3
"""Makes one .glb of Khronos's FlightHelmet, with a camera and light, to compare with Mitsuba.

    python3 tests/mitsuba/helmet.py FlightHelmet.gltf helmet.glb

The model (glTF-Sample-Assets, CC0) has rough metal, coats, textures, normal maps with tangents and
lenses that are partly transparent.  All textures end up in the file.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

from glb import container, looking, packed

# The helmet is 0.3 m wide and 0.7 m tall, faces +Z, and stands on y = 0.
CENTER = [0.0, 0.34, 0.01]
EYE, YFOV = [0.74, 0.52, 0.9], 0.70
# A lamp up on the left before it, W m⁻² sr⁻¹; its size, m.
LAMP, LAMP_SIZE, RADIANCE = [-0.7, 1.15, 0.9], 0.5, [17.0, 15.5, 13.5]
SKY = [0.2, 0.24, 0.3]


def helmet(source: Path) -> bytes:
    """The file."""
    root, data = packed(source)
    scene = root["scenes"][root.get("scene", 0)]
    scene.setdefault("extras", {})["environment"] = SKY
    camera = {"type": "perspective", "perspective": {"yfov": YFOV, "znear": 0.01}}
    root.setdefault("cameras", []).append(camera)
    scene["nodes"].append(len(root["nodes"]))
    camera_node = {"name": "Camera", "camera": len(root["cameras"]) - 1}
    root["nodes"].append({**camera_node, "matrix": looking(EYE, CENTER)})
    add_lamp(root, scene, data)
    root["buffers"] = [{"byteLength": len(data)}]
    return container(json.dumps(root).encode(), bytes(data))


def add_lamp(root: dict, scene: dict, data: bytearray) -> None:
    """A square that shines towards the helmet only."""
    h = LAMP_SIZE / 2
    # The node's −Z points at the helmet, so the front is −Z.
    corners = np.array([[-h, -h, 0], [-h, h, 0], [h, h, 0], [h, -h, 0]], "<f4")
    indices = np.array([0, 1, 2, 0, 2, 3], "<u2")
    accessors = []
    for values, component, kind in ((corners, 5126, "VEC3"), (indices, 5123, "SCALAR")):
        data.extend(bytes(-len(data) % 4))
        view = {"buffer": 0, "byteOffset": len(data), "byteLength": values.nbytes}
        data.extend(values.tobytes())
        root["bufferViews"].append(view)
        item = {"bufferView": len(root["bufferViews"]) - 1, "componentType": component}
        accessors.append({**item, "count": len(values), "type": kind})
    accessors[0].update(min=corners.min(axis=0).tolist(), max=corners.max(axis=0).tolist())
    first = len(root["accessors"])
    root["accessors"] += accessors
    strength = max(RADIANCE)
    root["materials"].append(
        {
            "name": "Lamp",
            "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
            "emissiveFactor": [x / strength for x in RADIANCE],
            "extensions": {
                "KHR_materials_emissive_strength": {"emissiveStrength": strength},
                "KHR_materials_specular": {"specularFactor": 0},
            },
        }
    )
    used = ["KHR_materials_emissive_strength", "KHR_materials_specular"]
    root["extensionsUsed"] = sorted({*root.get("extensionsUsed", []), *used})
    primitive = {
        "attributes": {"POSITION": first},
        "indices": first + 1,
        "material": len(root["materials"]) - 1,
    }
    root["meshes"].append({"name": "Lamp", "primitives": [primitive]})
    scene["nodes"].append(len(root["nodes"]))
    node = {"name": "Lamp", "mesh": len(root["meshes"]) - 1}
    root["nodes"].append({**node, "matrix": looking(LAMP, CENTER)})


if __name__ == "__main__":
    if len(sys.argv) != 3:
        print("usage: helmet.py FlightHelmet.gltf OUT.glb", file=sys.stderr)
        sys.exit(2)
    Path(sys.argv[2]).write_bytes(helmet(Path(sys.argv[1])))
