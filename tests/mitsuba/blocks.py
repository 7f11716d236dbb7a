#!/usr/bin/env python3
"""Does the program's picture of a scene look like Mitsuba 3's, with Mitsuba's own materials?

    venv/bin/python tests/mitsuba/blocks.py SCENE.glb [--size 256x256] [--save DIR] …

Metallic-roughness in Mitsuba is `principled`, another model of the same parameters, so the two
pictures have different expectations and `compare.py`'s test would say so.  Here the means of R, G
and B together over blocks of 32×32 pixels count: 95 % of the blocks must agree within 10 %.

Exit status: 0 they do, 1 they do not, 2 the input cannot be used.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

try:
    import mitsuba as mi
    import numpy as np
except ImportError as missing:
    print(f"error: {missing}; install it with: pip install mitsuba numpy", file=sys.stderr)
    sys.exit(2)

from agreement import average
from materials import OURS, PRINCIPLED
from renderers import add_options, exit_status, render_mitsuba, render_ours, subject

# Side of a block, pixels; how far its mean may be off; how many of the blocks must not be.
BLOCK, TOLERANCE, SHARE = 32, 0.10, 0.95
# Side of the blocks in the picture of the differences.
SHOWN = 8
# Okabe and Ito's blue and orange: ours is darker, ours is brighter.
BLUE, ORANGE = np.array([0, 114, 178]) / 255, np.array([230, 159, 0]) / 255


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    add_options(parser, {"size": (256, 256), "max-edges": 6, "spp": 64, "seeds": 4})
    text = "principled [the default], or our formulas as a plugin of Mitsuba"
    parser.add_argument("--materials", choices=[PRINCIPLED, OURS], default=PRINCIPLED, help=text)
    text = "writes blocks.png: ours, Mitsuba's, and the relative difference (± 20 %)"
    parser.add_argument("--save", type=Path, metavar="DIR", help=text)
    parser.add_argument("--json", action="store_true", help="prints JSON instead of lines")
    return exit_status(run, parser.parse_args())


def run(args: argparse.Namespace) -> int:
    """Renders both, compares, and says what came out."""
    scene = subject(args, args.materials)
    for note in scene.notes:
        print(f"note: {note}", file=sys.stderr)
    start = time.monotonic()
    ours = render_ours(args)
    middle = time.monotonic()
    theirs = render_mitsuba(scene, args)
    end = time.monotonic()
    kind = f"approximate: {PRINCIPLED}" if PRINCIPLED in scene.models else "exact"
    report = {
        "scene": str(args.scene),
        "mapping": kind,
        "size": args.size,
        "max_edges": args.max_edges,
        "seconds": [round(middle - start, 1), round(end - middle, 1)],
        **judge(ours, theirs),
    }
    if args.save:
        save(args.save, ours.mean(axis=0), theirs.mean(axis=0))
    print(json.dumps(report, indent=1) if args.json else lines(report))
    return 0 if report["agree"] else 1


def judge(ours: np.ndarray, theirs: np.ndarray) -> dict:
    """How many blocks of two sets of pictures, [seed, y, x, channel], agree."""
    blocks = [average(pictures, BLOCK)[..., 0] for pictures in (ours, theirs)]
    relative = difference(*(x.mean(axis=0) for x in blocks))
    # What of it is noise: both means' standard errors.
    noise = [0.0]
    if len(ours) > 1:
        variance = sum(x.var(axis=0, ddof=1) / len(x) for x in blocks)
        noise = np.sqrt(variance) / np.maximum(blocks[1].mean(axis=0), 1e-30)
    worst = np.unravel_index(np.argmax(np.abs(relative)), relative.shape)
    share = float(np.mean(np.abs(relative) <= TOLERANCE))
    return {
        "blocks": int(relative.size),
        "share": share,
        "median": float(np.median(np.abs(relative))),
        "worst": float(relative[worst]),
        "worst_pixel": [int(worst[1]) * BLOCK, int(worst[0]) * BLOCK],
        "noise": float(np.median(noise)),
        "agree": bool(share >= SHARE and np.isfinite(ours).all() and np.isfinite(theirs).all()),
    }


def difference(ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """(ours − theirs) / theirs; beyond all bounds where only theirs is black."""
    return np.where(ours == theirs, 0, (ours - theirs) / np.maximum(theirs, 1e-30))


def save(folder: Path, ours: np.ndarray, theirs: np.ndarray) -> None:
    """Writes both pictures, equally exposed, and their difference, side by side."""
    folder.mkdir(parents=True, exist_ok=True)
    white = max(float(np.quantile(theirs.mean(axis=-1), 0.99)), 1e-30)
    fine = [average(picture[None], SHOWN)[0, ..., 0] for picture in (ours, theirs)]
    relative = np.clip(difference(*fine) / (2 * TOLERANCE), -1, 1)[..., None]
    color = 1 - np.abs(relative) * (1 - np.where(relative > 0, ORANGE, BLUE))
    color = np.repeat(np.repeat(color, SHOWN, 0), SHOWN, 1)[: ours.shape[0], : ours.shape[1]]
    panels = [encoded(picture / white) for picture in (ours, theirs)] + [color]
    texels = (np.concatenate(panels, axis=1) * 255 + 0.5).astype(np.uint8)
    bitmap = mi.Bitmap(texels, mi.Bitmap.PixelFormat.RGB)
    bitmap.set_srgb_gamma(True)
    bitmap.write(str(folder / "blocks.png"))


def encoded(linear: np.ndarray) -> np.ndarray:
    """sRGB of linear values, clipped."""
    x = np.clip(linear, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def lines(report: dict) -> str:
    """The report for a person."""
    size, (ours, theirs) = "x".join(map(str, report["size"])), report["seconds"]
    x, y = report["worst_pixel"]
    return "\n".join(
        [
            f"{report['scene']}: {size}, K = {report['max_edges']}, {report['mapping']}",
            f"ours {ours} s, Mitsuba {theirs} s",
            f"{report['share']:.1%} of {report['blocks']} blocks of {BLOCK}×{BLOCK} agree within "
            f"{TOLERANCE:.0%} (wanted: {SHARE:.0%})",
            f"difference: median {report['median']:.1%}, worst {report['worst']:+.1%} at {x},{y}; "
            f"noise of a block: {report['noise']:.1%}",
            "AGREE" if report["agree"] else "FAILED",
        ]
    )


if __name__ == "__main__":
    sys.exit(main())
