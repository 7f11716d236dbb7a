#!/usr/bin/env python3
"""Does the program's picture of a scene agree with Mitsuba 3's?

    python3 -m venv venv && venv/bin/pip install mitsuba numpy
    venv/bin/python tests/mitsuba/compare.py SCENE.glb [--size 64x64] [--spp 64] …

Both render the scene with the same K and with independent seeds, the program bidirectionally,
Mitsuba with its path tracer (box filter, no roulette).  Where Mitsuba has no such material, it
gets our formulas as a plugin; `blocks.py` compares with its own model instead.

Two pictures agree if the means over the whole picture do, of R, G, B and their mean, all four at a
joint level of 99.9 %, and if none of their blocks of 16×16 pixels differs by more than 4.5 standard
errors.  The table says how large an error would have been found; if that is too large to mean
anything, there is no verdict.  `scene.py` says what can be compared; everything else is refused.

Exit status: 0 they agree, 1 they do not, 2 the input cannot be used or the samples are too few.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from pathlib import Path

try:
    import mitsuba as mi
    import numpy as np
except ImportError as missing:
    print(f"error: {missing}; install it with: pip install mitsuba numpy", file=sys.stderr)
    sys.exit(2)

from agreement import BLOCK, BLOCK_LIMIT, MEAN_LIMIT, average, compare, judge
from gltf import Unusable
from renderers import add_options, exit_status, render_mitsuba, render_ours, subject


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    add_options(parser, {"size": (64, 64), "max-edges": 5, "spp": 64, "seeds": 32})
    text = "writes ours.exr, mitsuba.exr and sigma.exr (of the blocks)"
    parser.add_argument("--save", type=Path, metavar="DIR", help=text)
    parser.add_argument("--json", action="store_true", help="prints JSON instead of a table")
    return exit_status(run, parser.parse_args())


def run(args: argparse.Namespace) -> int:
    """Renders both, compares, and says what came out."""
    if args.seeds < 16:
        raise Unusable(f"--seeds {args.seeds}: fewer than 16 do not tell their own variance")
    scene = subject(args)
    for note in scene.notes:
        print(f"note: {note}", file=sys.stderr)
    start = time.monotonic()
    ours = render_ours(args)
    middle = time.monotonic()
    theirs = render_mitsuba(scene, args)
    end = time.monotonic()
    report = {
        "scene": str(args.scene),
        "size": args.size,
        "max_edges": args.max_edges,
        "seeds": args.seeds,
        "spp": [args.spp, args.mitsuba_spp or args.spp],
        "scale": args.scale,
        "seconds": [round(middle - start, 1), round(end - middle, 1)],
        "mitsuba": mi.__version__,
        "variant": scene.variant,
        # Mitsuba's own materials, or our formulas as a plugin of it.
        "models": sorted(scene.models) or ["its own"],
        **judge(ours, theirs),
    }
    if args.save:
        save(args.save, ours, theirs)
    print(json.dumps(plain(report), indent=1) if args.json else table(report))
    return {"AGREE": 0, "FAILED": 1}.get(report["verdict"], 2)


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
        f"Mitsuba's variant {report['variant']}, materials: {', '.join(report['models'])}",
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
