"""Both renderers' pictures of a scene, and the options that say which."""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import traceback
from dataclasses import dataclass, field
from pathlib import Path

import mitsuba as mi
import numpy as np

import variant
from gltf import Unusable
from materials import OURS, PRINCIPLED
from scene import Scene, load, rgb_picture, to_mitsuba

REPOSITORY = Path(__file__).resolve().parents[2]
# Mitsuba's compiled variants hold all samples of a picture at once.
MOST_AT_ONCE = 1 << 21


def add_options(parser: argparse.ArgumentParser, defaults: dict) -> None:
    """What both programs are asked; `defaults` by name."""
    program = REPOSITORY / "target/release/bdpt-explorer"
    options = [
        ("--program", Path, "FILE", program, "the program [target/release/bdpt-explorer]"),
        ("--size", size, "WxH", None, "size of the picture [{}]"),
        ("--max-edges", positive, "K", None, "K, the most edges of a path [{}]"),
        ("--spp", positive, "N", None, "our samples per pixel and seed [{}]"),
        ("--mitsuba-spp", positive, "N", None, "Mitsuba's samples per pixel and seed [as --spp]"),
        ("--seeds", positive, "M", None, "independent pictures of each [{}]"),
        ("--first-seed", int, "S", 0, "seeds are S, S + 1, … [0]"),
        ("--scale", float, "F", 1.0, "negative control: multiplies our picture by F"),
    ]
    parser.add_argument("scene", type=Path, metavar="SCENE", help="a .glb or .gltf file")
    text = "Mitsuba gets what the program's `export` writes, of a built-in scene too"
    parser.add_argument("--export", action="store_true", help=text)
    for name, kind, metavar, default, text in options:
        value = defaults.get(name[2:], default)
        shown = "x".join(map(str, value)) if isinstance(value, tuple) else value
        parser.add_argument(
            name, type=kind, metavar=metavar, default=value, help=text.format(shown)
        )


def size(text: str) -> tuple[int, int]:
    """WxH."""
    width, height = (positive(part) for part in text.split("x"))
    return width, height


def positive(text: str) -> int:
    """A number of things."""
    number = int(text)
    if number < 1:
        raise ValueError(text)
    return number


def seeds(args: argparse.Namespace) -> range:
    """The seeds of both; their random numbers have nothing in common."""
    return range(args.first_seed, args.first_seed + args.seeds)


@dataclass
class Exported:
    """A scene that the program itself wrote for Mitsuba, in place of `scene.Scene`."""

    scene: mi.Scene
    variant: str
    models: set[str] = field(default_factory=set)
    notes: list[str] = field(default_factory=list)


def subject(args: argparse.Namespace, model: str = OURS) -> Scene | Exported:
    """What Mitsuba is to render: read by this program, or written by the other one."""
    if not args.export:
        return load(args.scene, model)
    with tempfile.TemporaryDirectory() as folder:
        command = ["export", args.scene, "--format", "mitsuba", "-o", folder, *view(args)]
        said = run_program(args, command + (["--plugins"] if model == OURS else []))
        notes = [line.removeprefix("note: ") for line in said.splitlines()]
        mi.set_variant(variant.PLAIN)
        models = {PRINCIPLED} if any("`principled`" in note for note in notes) else set()
        if list(Path(folder).glob("*.py")):
            variant.use_plugins()
            models = {OURS}
        scene = mi.load_file(str(Path(folder) / "scene.xml"))
    return Exported(scene, mi.variant(), models, notes)


def view(args: argparse.Namespace) -> list:
    """What of the scene both programs show."""
    return ["--size", "x".join(map(str, args.size)), "--max-edges", args.max_edges]


def run_program(args: argparse.Namespace, command: list) -> str:
    """Runs the program; what it said on stderr."""
    try:
        words = [str(part) for part in [args.program, *command]]
        done = subprocess.run(words, capture_output=True)
    except OSError as error:
        reason = f"cannot be run ({error.strerror}); build it, or use --program"
        raise Unusable(f"{args.program}: {reason}") from error
    said = done.stderr.decode(errors="replace").strip()
    if done.returncode != 0:
        raise Unusable(f"the program failed: {said}")
    return said


def render_ours(args: argparse.Namespace) -> np.ndarray:
    """The program's pictures, [seed, y, x, channel]."""
    pictures = []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "ours.exr"
        command = ["render", args.scene, "-o", file, "--spp", args.spp, *view(args)]
        for seed in seeds(args):
            run_program(args, [*command, "--seed", seed])
            pictures.append(rgb_picture(file))
    return np.stack(pictures) * args.scale


def render_mitsuba(scene: Scene | Exported, args: argparse.Namespace) -> np.ndarray:
    """Mitsuba's pictures, [seed, y, x, channel]."""
    if isinstance(scene, Exported):
        loaded = scene.scene
    else:
        with tempfile.TemporaryDirectory() as folder:
            loaded = mi.load_dict(to_mitsuba(scene, Path(folder), args.size, args.max_edges))
    spp = args.mitsuba_spp or args.spp
    parts = -(-spp * args.size[0] * args.size[1] // MOST_AT_ONCE)
    pictures = []
    for seed in seeds(args):
        picture = 0.0
        for part in range(parts):
            share = spp * (part + 1) // parts - spp * part // parts
            if share:
                drawn = mi.render(loaded, spp=share, seed=seed * parts + part)
                picture = picture + np.array(drawn, float) * (share / spp)
        pictures.append(picture)
    return np.stack(pictures)


def exit_status(run, args: argparse.Namespace) -> int:
    """What a program's `run` returns; 2 if the input cannot be used."""
    try:
        return run(args)
    except Unusable as error:
        print(f"error: {error}", file=sys.stderr)
    except Exception:  # a bug here is no disagreement, which status 1 would mean
        traceback.print_exc()
    return 2
