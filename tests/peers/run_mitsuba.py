"""Renders an exported scene in Mitsuba 3 for so many seconds of CPU, each pass with its own seed.

    python3 run_mitsuba.py scene.xml out.npy --seconds 30 [--integrator ptracer] [--first-seed N]

Prints JSON: samples per pixel, seconds of CPU that the passes took.  Paths are as long as they get:
Mitsuba's own roulette from the fifth edge on.  With 0 seconds it renders one pass.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "mitsuba"))
import variant  # noqa: E402  (it chooses the LLVM before Mitsuba is imported)

# Samples per pixel and pass: the compiled variants hold all samples of a pass at once.
SPP = {variant.PLAIN: 4, variant.COMPILED: 32}


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("out")
    parser.add_argument("--seconds", type=float, required=True)
    parser.add_argument("--integrator", default="path")
    parser.add_argument("--first-seed", type=int, default=0)
    args = parser.parse_args()
    name = variant.COMPILED if variant.LLVM else variant.PLAIN
    variant.mi.set_variant(name)
    endless = {"max_depth": -1, "rr_depth": 5, "integrator": args.integrator}
    scene = variant.mi.load_file(args.scene, **endless)
    start, passes, total = time.process_time(), 0, 0.0
    while passes == 0 or time.process_time() - start < args.seconds:
        seed = args.first_seed + passes
        total = total + np.array(variant.mi.render(scene, spp=SPP[name], seed=seed), float)
        passes += 1
    np.save(args.out, total / passes)
    cpu = time.process_time() - start
    print(json.dumps({"variant": name, "spp": passes * SPP[name], "render_cpu": cpu}))


if __name__ == "__main__":
    main()
