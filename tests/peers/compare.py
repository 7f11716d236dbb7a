#!/usr/bin/env python3
"""How efficient is the program beside other renderers? Three rooms, one measure, one run.

    python3 -m venv venv && venv/bin/pip install mitsuba pyluxcore numpy
    venv/bin/python tests/peers/compare.py [--rooms A,B,C] [--seconds 60] [-o peers] [--quick] …

    efficiency = 1 / (relMSE · CPU seconds)       relMSE = mean of (a − b)² / (b² + 0.01)

over all pixels and channels (trimmed: without the worst 0.1 % of the pixels); b is the reference,
whose noise is *not* subtracted.  CPU seconds are user and system time of the whole process, with
everything it loads.  All renderers get the same export of the same scene, at 256×256, and about as
many seconds of CPU (ours by a number of samples that a short run before tells), with as many
threads as they like; Mitsuba's kernels have been compiled before and are loaded from disk.  Ours is
truncated at K edges, LuxCore at its depths; the others and the reference are not.  A reference is a
long run with other seeds: in A Mitsuba's path tracer, in C its light tracer, in B ours with 64
edges, as Mitsuba cannot make B's caustics.  Its noise is that of two halves; `mean` is the picture's mean
over the reference's, with the standard error of the former: more than a few of those off is a bias.
Leave the machine alone meanwhile.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import platform
import resource
import shlex
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from datetime import date
from pathlib import Path

import numpy as np

from rooms import ROOMS

HERE = Path(__file__).resolve().parent
PROGRAM = HERE.parents[1] / "target/release/bdpt-explorer"
# Seeds of references are far from those of entries.
REFERENCE_SEED = 1000
TRIMMED = 1e-3
# What of ours needs the fewest samples.
BEST = "--sampler sobol --strategies suggested"
# Who renders the reference of a room.
REFERENCES = {"A": "mitsuba path", "B": f"ours --max-edges 64 {BEST}", "C": "mitsuba ptracer"}
# Samples per pixel of the run that tells how many of ours are a second.
PILOT = 2
COLUMNS = [
    *("room", "renderer", "CPU s", "rendering", "spp"),
    *("relMSE", "trimmed", "eff", "eff trimmed", "mean"),
]


@dataclass
class Run:
    """A finished rendering."""

    picture: np.ndarray
    # Of the whole process, and what of it was rendering; seconds.
    cpu: float
    rendering: float
    spp: float
    variant: str = ""


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    text = "our options, an entry for each time this is given [plain, the best there are, pt, lt]"
    parser.add_argument("--ours", action="append", metavar="OPTIONS", help=text)
    parser.add_argument("--program", type=Path, default=PROGRAM, help=f"ours [{PROGRAM}]")
    parser.add_argument("--rooms", default="A,B,C", help="which of A, B, C [all]")
    parser.add_argument("--size", type=int, default=256, help="pixels, each way [256]")
    parser.add_argument("--max-edges", type=int, default=16, help="our K [16]")
    parser.add_argument("--seconds", type=float, default=60, help="of CPU, each, about [60]")
    text = "how much longer the reference renders [10]"
    parser.add_argument("--reference", type=float, default=10, metavar="TIMES", help=text)
    parser.add_argument("--lux-depth", type=int, default=10, help="LuxCore's depths [10]")
    parser.add_argument("--without", default="", metavar="NAME,…", help="not mitsuba, luxcore")
    parser.add_argument("-o", "--output", type=Path, default=Path("peers"), help="folder [peers]")
    text = "64×64 and two seconds each: does everything run?"
    parser.add_argument("--quick", action="store_true", help=text)
    args = parser.parse_args()
    if args.quick:
        args.size, args.seconds, args.reference = 64, 2.0, 2.0
    args.output.mkdir(parents=True, exist_ok=True)
    rows = []
    for name in args.rooms.split(","):
        with tempfile.TemporaryDirectory() as folder:
            rows += compare(name, Path(folder), args)
        write(rows, args)
    print((args.output / "report.md").read_text())
    return 0


def compare(room: str, folder: Path, args: argparse.Namespace) -> list[dict]:
    """The rows of a room."""
    scene = folder / "room.glb"
    ROOMS[room](scene)
    size = ["--size", f"{args.size}x{args.size}"]
    export = [args.program, "export", scene, "--format", "mitsuba", "-o", folder / "room", *size]
    launch(export)
    if "mitsuba" not in args.without:
        # Compiled kernels stay on disk: whoever measures pays for loading them, not for compiling.
        for integrator in ("path", "ptracer"):
            render(f"mitsuba {integrator}", folder, 0, 0, args)
    name = REFERENCES[room]
    halves = [
        render(name, folder, 0.5 * args.reference * args.seconds, REFERENCE_SEED * i, args)
        for i in (1, 2)
    ]
    weights = [half.spp / sum(half.spp for half in halves) for half in halves]
    reference = sum(w * half.picture for w, half in zip(weights, halves))
    # The halves differ by the sum of their variances, which is four times that of their mean.
    noise = relative_errors(halves[0].picture, halves[1].picture) / 4
    np.save(args.output / f"reference-{room}.npy", reference)
    rows = [row(room, f"reference: {name}", halves, noise, 1.0, 0.0)]
    for entry in entries(room, args):
        run = render(entry, folder, args.seconds, 0, args)
        np.save(args.output / f"{room}-{entry.replace(' ', '')}.npy", run.picture)
        off = run.picture - reference
        error = float(np.sqrt(np.sum(np.mean(off, axis=-1) ** 2)) / off[..., 0].size)
        mean = float(reference.mean())
        errors = relative_errors(run.picture, reference)
        rows.append(row(room, entry, [run], errors, float(run.picture.mean()) / mean, error / mean))
        print(json.dumps(rows[-1]), flush=True)
    return rows


def entries(room: str, args: argparse.Namespace) -> list[str]:
    """Who renders a room; light tracers see neither mirrors nor glass."""
    ours = args.ours
    if ours is None:
        ours = ["", BEST, "--integrator pt"] + (["--integrator lt"] if room != "B" else [])
    edges = f"--max-edges {args.max_edges}"
    found = [f"ours {more if '--max-edges' in more else f'{edges} {more}'}".strip() for more in ours]
    if "mitsuba" not in args.without:
        found += ["mitsuba path"] + (["mitsuba ptracer"] if room != "B" else [])
    return found + (["luxcore"] if "luxcore" not in args.without else [])


def render(entry: str, folder: Path, seconds: float, seed: int, args: argparse.Namespace) -> Run:
    """Renders, in a process of its own."""
    who, _, options = entry.partition(" ")
    scene, out = folder / "room/scene.xml", folder / "out.npy"
    time = ["--seconds", seconds]
    if who == "ours":
        file, stats = folder / "out.exr", folder / "stats.json"
        size = ["--size", f"{args.size}x{args.size}"]
        command = [args.program, "render", folder / "room.glb", "-o", file, "--backend", "cpu"]
        command += ["--stats", stats, *size, *shlex.split(options)]
        launch([*command, "--spp", PILOT])
        each = json.loads(stats.read_text())["cpu_seconds"] / PILOT
        cpu, _ = launch([*command, "--seed", seed, "--spp", max(1, round(seconds / each))])
        said = json.loads(stats.read_text())
        return Run(read_exr(file), cpu, said["cpu_seconds"], said["spp"])
    python = [sys.executable, HERE / f"run_{who}.py", scene, out, *time]
    if who == "mitsuba":
        python += ["--integrator", options, "--first-seed", seed]
    else:
        python += ["--depth", args.lux_depth, "--seed", seed + 1]
    cpu, said = launch(python)
    told = json.loads(said.splitlines()[-1])
    return Run(np.load(out).astype(float), cpu, told["render_cpu"], told["spp"], told["variant"])


def launch(command: list) -> tuple[float, str]:
    """A command's seconds of CPU, user and system, of all its threads; what it said."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        said = (done.stdout + done.stderr)[-2000:]
        sys.exit(f"error: status {done.returncode}: {shlex.join(map(str, command))}\n{said}")
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime, done.stdout


def read_exr(file: Path) -> np.ndarray:
    """A picture's linear RGB."""
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    bitmap = mi.Bitmap(str(file))
    return np.array(bitmap.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False), float)


def relative_errors(picture: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """(a − b)² / (b² + 0.01), means over the channels."""
    return np.mean((picture - reference) ** 2 / (reference**2 + 0.01), axis=-1)


def row(room, name, runs, errors, mean, error) -> dict:
    """A row of the table."""
    cpu = sum(run.cpu for run in runs)
    sorted_errors = np.sort(errors, axis=None)
    all_pixels = float(sorted_errors.mean())
    trimmed = float(sorted_errors[: round(sorted_errors.size * (1 - TRIMMED))].mean())
    variant = f" ({runs[0].variant})" if runs[0].variant else ""
    values = [
        *(room, name + variant, cpu, sum(run.rendering for run in runs), sum(r.spp for r in runs)),
        *(all_pixels, trimmed, 1 / (all_pixels * cpu), 1 / (trimmed * cpu), mean),
    ]
    return {**dict(zip(COLUMNS, values)), "standard error": error}


def write(rows: list[dict], args: argparse.Namespace) -> None:
    """The table as Markdown and as CSV."""
    with open(args.output / "report.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, [*COLUMNS, "standard error"])
        writer.writeheader()
        writer.writerows(rows)
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + " --- |" * len(COLUMNS)]
    for item in rows:
        cells = [item["room"], item["renderer"], f"{item['CPU s']:.1f}", f"{item['rendering']:.1f}"]
        cells += [f"{item['spp']:.0f}", f"{item['relMSE']:.2e}", f"{item['trimmed']:.2e}"]
        cells += [f"{item['eff']:.3g}", f"{item['eff trimmed']:.3g}"]
        cells.append(f"{item['mean']:.4f} ± {item['standard error']:.4f}")
        lines.append("| " + " | ".join(cells) + " |")
    how = f"{args.size}×{args.size}, about {args.seconds:g} s of CPU each"
    lines += ["", f"{how}; {os.cpu_count()} CPUs, {processor()}; {date.today()}.", ""]
    lines += ["".join(__doc__.partition("    efficiency =")[1:])]
    (args.output / "report.md").write_text("\n".join(lines))


def processor() -> str:
    """The processor's name."""
    info = Path("/proc/cpuinfo")
    names = info.read_text().splitlines() if info.exists() else []
    found = [line.partition(":")[2].strip() for line in names if line.startswith("model name")]
    return found[0] if found else platform.processor()


if __name__ == "__main__":
    sys.exit(main())
