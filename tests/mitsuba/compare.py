#!/usr/bin/env python3
"""Does the program's picture of a scene agree with Mitsuba 3's?

    python3 -m venv venv && venv/bin/pip install mitsuba numpy
    venv/bin/python tests/mitsuba/compare.py SCENE.glb [--size 64x64] [--spp 64] …

Both render the scene with the same K and with independent seeds, the program bidirectionally,
Mitsuba with its path tracer (variant scalar_rgb, box filter, no roulette).  Two pictures agree if
the means over the whole picture do, of R, G, B and their mean, all four at a joint level of
99.9 %, and if none of their blocks of 16×16 pixels differs by more than 4.5 standard errors.  The
table says how large an error would have been found; if that is too large to mean anything, there
is no verdict.  `scene.py` says what can be compared; everything else is refused.

Exit status: 0 they agree, 1 they do not, 2 the input cannot be used or the samples are too few.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
import traceback
from pathlib import Path

try:
    import mitsuba as mi
    import numpy as np
except ImportError as missing:
    print(f"error: {missing}; install it with: pip install mitsuba numpy", file=sys.stderr)
    sys.exit(2)

from agreement import BLOCK, BLOCK_LIMIT, MEAN_LIMIT, average, compare, judge
from gltf import Unusable
from scene import Scene, load, rgb_picture, to_mitsuba

REPOSITORY = Path(__file__).resolve().parents[2]


def main() -> int:
    """The command line."""
    args = parse_arguments()
    try:
        report = run(args)
    except Unusable as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except Exception:  # a bug here is no disagreement, which status 1 would mean
        traceback.print_exc()
        return 2
    print(json.dumps(plain(report), indent=1) if args.json else table(report))
    return {"AGREE": 0, "FAILED": 1}.get(report["verdict"], 2)


def parse_arguments() -> argparse.Namespace:
    """What the user asks for."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    program = REPOSITORY / "target/release/bdpt-explorer"
    options = [
        ("--program", Path, "FILE", program, "the program [target/release/bdpt-explorer]"),
        ("--size", size, "WxH", (64, 64), "size of the picture [64x64]"),
        ("--max-edges", positive, "K", 5, "K, the most edges of a path [5]"),
        ("--spp", positive, "N", 64, "our samples per pixel and seed [64]"),
        ("--mitsuba-spp", positive, "N", None, "Mitsuba's samples per pixel and seed [as --spp]"),
        ("--seeds", positive, "M", 32, "independent pictures of each, at least 16 [32]"),
        ("--first-seed", int, "S", 0, "seeds are S, S + 1, … [0]"),
        ("--scale", float, "F", 1.0, "negative control: multiplies our picture by F"),
        (
            "--save",
            Path,
            "DIR",
            None,
            "writes ours.exr, mitsuba.exr and sigma.exr (of the blocks)",
        ),
    ]
    parser.add_argument("scene", type=Path, metavar="SCENE", help="a .glb or .gltf file")
    for name, kind, metavar, default, text in options:
        parser.add_argument(name, type=kind, metavar=metavar, default=default, help=text)
    parser.add_argument("--json", action="store_true", help="prints JSON instead of a table")
    args = parser.parse_args()
    args.mitsuba_spp = args.mitsuba_spp or args.spp
    return args


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


def run(args: argparse.Namespace) -> dict:
    """Renders both and compares."""
    if args.seeds < 16:
        raise Unusable(f"--seeds {args.seeds}: fewer than 16 do not tell their own variance")
    scene = load(args.scene)
    for note in scene.notes:
        print(f"note: {note}", file=sys.stderr)
    start = time.monotonic()
    ours = render_ours(args) * args.scale
    middle = time.monotonic()
    theirs = render_mitsuba(scene, args)
    end = time.monotonic()
    report = {
        "scene": str(args.scene),
        "size": args.size,
        "max_edges": args.max_edges,
        "seeds": args.seeds,
        "spp": [args.spp, args.mitsuba_spp],
        "scale": args.scale,
        "seconds": [round(middle - start, 1), round(end - middle, 1)],
        "mitsuba": mi.__version__,
        **judge(ours, theirs),
    }
    if args.save:
        save(args.save, ours, theirs)
    return report


def seeds(args: argparse.Namespace) -> range:
    """The seeds of both; their random numbers have nothing in common."""
    return range(args.first_seed, args.first_seed + args.seeds)


def render_ours(args: argparse.Namespace) -> np.ndarray:
    """The program's pictures, [seed, y, x, channel]."""
    pictures = []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "ours.exr"
        command = [args.program, "render", args.scene, "-o", file, "--spp", args.spp]
        command += ["--size", "x".join(map(str, args.size)), "--max-edges", args.max_edges]
        for seed in seeds(args):
            try:
                done = subprocess.run(
                    [str(part) for part in [*command, "--seed", seed]], capture_output=True
                )
            except OSError as error:
                reason = f"cannot be run ({error.strerror}); build it, or use --program"
                raise Unusable(f"{args.program}: {reason}") from error
            if done.returncode != 0:
                said = done.stderr.decode(errors="replace").strip()
                raise Unusable(f"the program failed: {said}")
            pictures.append(rgb_picture(file))
    return np.stack(pictures)


def render_mitsuba(scene: Scene, args: argparse.Namespace) -> np.ndarray:
    """Mitsuba's pictures, [seed, y, x, channel]."""
    with tempfile.TemporaryDirectory() as folder:
        loaded = mi.load_dict(to_mitsuba(scene, Path(folder), args.size, args.max_edges))
    pictures = (mi.render(loaded, spp=args.mitsuba_spp, seed=seed) for seed in seeds(args))
    return np.stack([np.array(picture, float) for picture in pictures])


def plain(value):
    """JSON knows no infinity and no NaN: they become null."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def save(folder: Path, ours: np.ndarray, theirs: np.ndarray) -> None:
    """Writes the mean pictures and the blocks' deviations, one pixel each."""
    folder.mkdir(parents=True, exist_ok=True)
    sigma = compare(average(ours, BLOCK), average(theirs, BLOCK), BLOCK_LIMIT)["sigma"][..., 1:]
    for name, picture in (
        ("ours", ours.mean(axis=0)),
        ("mitsuba", theirs.mean(axis=0)),
        ("sigma", sigma),
    ):
        mi.Bitmap(picture.astype(np.float32)).write(str(folder / f"{name}.exr"))


def table(report: dict) -> str:
    """The report for a person."""
    size_text = "x".join(map(str, report["size"]))
    scale = f", ours × {report['scale']}" if report["scale"] != 1 else ""
    (spp, mitsuba_spp), (ours, theirs) = report["spp"], report["seconds"]
    head = (
        f"{'ours':>11}{'Mitsuba':>11}{'difference':>12}{'sigma':>8}{'limit':>7}{'would see':>11}"
    )
    lines = [
        f"{report['scene']}: {size_text}, K = {report['max_edges']}, M = {report['seeds']}{scale}",
        f"ours {spp} spp, {ours} s · Mitsuba {report['mitsuba']} {mitsuba_spp} spp, {theirs} s",
        "",
        f"{'':24}{head}",
    ]
    for row in report["rows"]:
        lines.append(f"{'whole picture, ' + row['quantity']:24}" + line(row["mean"], MEAN_LIMIT))
    for row in report["rows"]:
        x, y = row["block"]["pixel"]
        name = f"block at {x},{y}, {row['quantity']}"
        lines.append(f"{name:24}" + line(row["block"], BLOCK_LIMIT))
    lines += ["(the worst block of all, and what half of the blocks would see)", ""]
    return "\n".join(lines) + "; ".join([report["verdict"], *report["reasons"]])


def line(x: dict, limit: float) -> str:
    """The figures of one row."""
    values = f"{x['ours']:11.5g}{x['mitsuba']:11.5g}{x['relative']:+12.2%}"
    return f"{values}{x['sigma']:+8.2f}{limit:7.2f}{x['seen']:11.2%}"


if __name__ == "__main__":
    sys.exit(main())
