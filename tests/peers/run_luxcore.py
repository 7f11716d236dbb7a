"""Renders an exported scene in LuxCore, bidirectionally, for so many seconds of CPU.

    python3 run_luxcore.py scene.xml out.npy --seconds 30 [--depth 10] [--seed N]

Reads of Mitsuba's scene what the rooms of `rooms.py` are made of.  Roulette is off, as LuxCore's
bidirectional integrator is too bright with it; so paths end at `--depth` vertices on either side.
Prints JSON: samples per pixel, seconds of CPU that rendering took.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pyluxcore


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("scene", type=Path)
    parser.add_argument("out")
    parser.add_argument("--seconds", type=float, required=True)
    parser.add_argument("--depth", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    pyluxcore.Init()
    pyluxcore.SetLogHandler(lambda message: None)
    root = ElementTree.parse(args.scene).getroot()
    defaults = {item.get("name"): item.get("value") for item in root.findall("default")}
    width, height = int(defaults["width"]), int(defaults["height"])
    scene = pyluxcore.Scene()
    scene.Parse(properties(camera(root.find("sensor"), height)))
    for number, shape in enumerate(root.findall("shape")):
        add(scene, shape, number, args.scene.parent)
    settings = {
        "renderengine.type": "BIDIRCPU",
        "renderengine.seed": args.seed,
        "sampler.type": "SOBOL",
        "path.maxdepth": args.depth,
        "light.maxdepth": args.depth,
        "path.russianroulette.depth": 999,
        "light.russianroulette.depth": 999,
        "film.width": width,
        "film.height": height,
        "film.filter.type": "NONE",
        "film.imagepipelines.0.0.type": "NOP",
        "film.outputs.0.type": "RGB",
        "film.outputs.0.filename": "unused.exr",
    }
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties(settings), scene))
    start = time.process_time()
    session.Start()
    while time.process_time() - start < args.seconds:
        time.sleep(0.05)
    session.UpdateStats()
    session.Stop()
    cpu = time.process_time() - start
    picture = np.zeros((height, width, 3), np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, picture, 0)
    np.save(args.out, picture[::-1])
    spp = session.GetStats().Get("stats.renderengine.pass").GetFloat()
    print(json.dumps({"variant": "BIDIRCPU", "spp": spp, "render_cpu": cpu}), flush=True)
    # It may crash when it is taken apart.
    os._exit(0)


def properties(values: dict) -> pyluxcore.Properties:
    """LuxCore's form of them."""
    result = pyluxcore.Properties()
    for name, value in values.items():
        result.Set(pyluxcore.Property(name, value))
    return result


def value(item: ElementTree.Element, name: str) -> str:
    """A property's value."""
    return item.find(f"*[@name='{name}']").get("value")


def numbers(text: str) -> list[float]:
    """The numbers in a value."""
    return [float(x) for x in text.replace(",", " ").split()]


def camera(sensor: ElementTree.Element, height: int) -> dict:
    """The pinhole; LuxCore's film is flipped, and then one row low."""
    matrix = np.array(numbers(sensor.find("transform/matrix").get("value"))).reshape(4, 4)
    position, up, axis = matrix[:3, 3], matrix[:3, 1], matrix[:3, 2]
    row = -2 / height
    return {
        "scene.camera.type": "perspective",
        "scene.camera.lookat.orig": position.tolist(),
        "scene.camera.lookat.target": (position + axis).tolist(),
        "scene.camera.up": up.tolist(),
        "scene.camera.fieldofview": float(value(sensor, "fov")),
        "scene.camera.screenwindow": [-1.0, 1.0, -1.0 + row, 1.0 + row],
        "scene.camera.cliphither": float(value(sensor, "near_clip")),
        "scene.camera.autofocus.enable": False,
        "scene.camera.lensradius": 0.0,
    }


def add(scene: pyluxcore.Scene, shape: ElementTree.Element, number: int, folder: Path) -> None:
    """A shape with its material and, perhaps, its emission."""
    points, normals, faces = read_ply(folder / value(shape, "filename"))
    scene.DefineMesh(f"mesh{number}", points, faces, normals, None, None, None)
    name = f"scene.materials.m{number}"
    bsdf = shape.find("bsdf")
    bsdf = bsdf.find("bsdf") if bsdf.get("type") == "twosided" else bsdf
    kind = bsdf.get("type")
    if kind == "diffuse":
        material = {f"{name}.type": "matte", f"{name}.kd": numbers(value(bsdf, "reflectance"))}
    elif kind == "conductor":
        material = {f"{name}.type": "mirror", f"{name}.kr": [1.0, 1.0, 1.0]}
    elif kind == "dielectric":
        material = {
            f"{name}.type": "glass",
            f"{name}.kr": [1.0, 1.0, 1.0],
            f"{name}.kt": numbers(value(bsdf, "specular_transmittance")),
            f"{name}.interiorior": float(value(bsdf, "int_ior")),
            f"{name}.exteriorior": 1.0,
        }
    else:
        sys.exit(f"{shape}: no mapping for {kind}")
    emitter = shape.find("emitter")
    if emitter is not None:
        material[f"{name}.emission"] = numbers(value(emitter, "radiance"))
        material[f"{name}.emission.normalizebycolor"] = False
    scene.Parse(properties(material))
    place = f"scene.objects.o{number}"
    scene.Parse(properties({f"{place}.shape": f"mesh{number}", f"{place}.material": f"m{number}"}))


def read_ply(path: Path) -> tuple[list, list | None, list]:
    """Points, normals and triangles of a binary PLY file, as lists of tuples."""
    head, _, data = path.read_bytes().partition(b"end_header\n")
    lines = head.decode().splitlines()
    names = [line.split()[2] for line in lines if line.startswith("property float ")]
    count = [int(line.split()[2]) for line in lines if line.startswith("element ")]
    rows = np.frombuffer(data, "<f4", count[0] * len(names)).reshape(count[0], len(names))
    faces = np.frombuffer(data, [("n", "u1"), ("i", "<i4", 3)], offset=rows.nbytes)["i"]
    rows = rows.tolist()
    normals = [tuple(row[3:6]) for row in rows] if "nx" in names else None
    return [tuple(row[:3]) for row in rows], normals, [tuple(face) for face in faces.tolist()]


if __name__ == "__main__":
    main()
