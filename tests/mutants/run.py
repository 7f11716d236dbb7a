#!/usr/bin/env python3
"""Does the suite notice a slip? Each mistake of slips.json is made on purpose, alone, and the tests are run until one fails.

    python3 tests/mutants/run.py                        # all of them, and report.md anew
    python3 tests/mutants/run.py --only eta-not-squared # some; their rows in report.md are replaced
    python3 tests/mutants/run.py --check                # only: does every slip still fit its file?

Everything is compiled once: in a copy of the sources each slip stands beside what is right, and BDPT_MUTANT, a number, says which of
them is made. Shaders are changed while they are put together. The test that killed a slip before is tried first (--fresh: it is not).
"""

import argparse
import concurrent.futures
import datetime
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent

# What is run until a test fails: (suite, filters), what is quick and likely to notice first. A filter is a part of a test's name;
# those that begin with "!" are left out.
STAGES = [
    ("lib", ["bdpt::", "film::", "math::", "rng::", "scene::"]),
    ("ladder", ["normals::", "sampling::", "weights::", "definition", "evaluation", "reciprocal"]),
    ("ladder", ["replay::"]),
    ("gpu", ["twins"]),
    ("hard", ["mistakes::", "weights::"]),
    ("gpu", ["joins::", "lockstep::", "paths::"]),
    ("ladder", ["!normals::", "!sampling::", "!weights::", "!definition", "!evaluation", "!reciprocal", "!replay::"]),
    ("hard", ["!mistakes::", "!weights::"]),
    ("gpu", ["!twins", "!joins::", "!lockstep::", "!paths::"]),
    ("scenes", []),
    ("check", []),
]
# Tests that judge no rendering, or that pin its numbers: these notice every change, a right one as well.
LEFT_OUT = {"lib": ["pilot::", "pinned", "no_broken_file"], "gpu": ["engine::", "raster::"], "scenes": ["fuzz"]}
SUITES = ["lib", "ladder", "hard", "scenes", "check", "gpu"]
# A stage may take so many times what it takes when all is right, and a little.
PATIENCE, GRACE = 6.0, 60.0

HOOK = "    pub fn push(&mut self, name: &str, text: &str) {\n"


def is_shader(slip):
    return slip["file"].startswith("shaders/")


def is_judged_by(slip, suite):
    """The device's side is judged by the device's tests alone; what both sides use, by all."""
    return suite == "gpu" or not (is_shader(slip) or slip["file"].startswith("src/gpu/"))


def load_slips():
    """The slips with their numbers, from 1, and where in its file each stands. Ends the program if one does not fit."""
    slips = json.loads((HERE / "slips.json").read_text())
    wrong, taken = [], {}
    for number, slip in enumerate(slips, 1):
        text, at = (ROOT / slip["file"]).read_text(), slip.get("at", slip["from"])
        if text.count(at) != 1 or at.count(slip["from"]) != 1:
            wrong.append(f"{slip['name']}: {slip['file']} has '{at}' {text.count(at)} times, which has '{slip['from']}' {at.count(slip['from'])} times; each must be 1")
            continue
        start = text.index(at) + at.index(slip["from"])
        slip.update(number=number, start=start, end=start + len(slip["from"]))
        for other in taken.setdefault(slip["file"], []):
            if slip["start"] < other["end"] and other["start"] < slip["end"]:
                wrong.append(f"{slip['name']} and {other['name']} change the same text")
        taken[slip["file"]].append(slip)
    if len({slip["name"] for slip in slips}) < len(slips):
        wrong.append("two slips have the same name")
    if wrong:
        sys.exit("\n".join(wrong))
    return slips


def choice(slip):
    """What stands in the copy for the right text."""
    branches = f"if crate::mutant::on({slip['number']}) {{ {slip['to']} }} else {{ {slip['from']} }}"
    return branches if slip.get("statement") else f"({branches})"


def literal(text):
    return json.dumps(text, ensure_ascii=False)


def sources(slips):
    """The files of the copy: path and bytes."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True)
    paths = [path for path in listed.stdout.decode().split("\0") if path and (ROOT / path).is_file()]
    files = {path: (ROOT / path).read_bytes() for path in paths}
    for path in {slip["file"] for slip in slips if not is_shader(slip)}:
        text = files[path].decode()
        for slip in sorted((slip for slip in slips if slip["file"] == path), key=lambda slip: -slip["start"]):
            text = text[: slip["start"]] + choice(slip) + text[slip["end"] :]
        files[path] = text.encode()
    shader = files["src/gpu/shader.rs"].decode()
    if shader.count(HOOK) != 1:
        sys.exit("src/gpu/shader.rs: where a file is appended has changed; tell run.py (HOOK)")
    hooked = HOOK + "        let text = &*crate::mutant::shader(name, text);\n"
    files["src/gpu/shader.rs"] = shader.replace(HOOK, hooked).encode()
    rows = []
    for slip in filter(is_shader, slips):
        at = slip.get("at", slip["from"])
        texts = [slip["file"].removeprefix("shaders/"), at, at.replace(slip["from"], slip["to"])]
        rows.append(f"    ({slip['number']}, {', '.join(map(literal, texts))}),\n")
    table = f"const SHADERS: &[(u32, &str, &str, &str)] = &[\n{''.join(rows)}];\n"
    files["src/mutant.rs"] = (HERE / "switch.rs").read_bytes() + table.encode()
    files["src/lib.rs"] += b"pub mod mutant;\n"
    return files


def write_copy(slips, tree):
    """Writes what differs, so that only that is compiled again."""
    files = sources(slips)
    for path, content in files.items():
        target = tree / path
        if not target.is_file() or target.read_bytes() != content:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
    for path in [path for path in tree.rglob("*") if path.is_file()]:
        if str(path.relative_to(tree)) not in files:
            path.unlink()


def build(tree, target):
    """Compiles the suites; the program of each."""
    chosen = [word for suite in SUITES for word in (["--lib"] if suite == "lib" else ["--test", suite])]
    command = ["cargo", "test", "--no-run", "--message-format=json-render-diagnostics", *chosen]
    built = subprocess.run(command, cwd=tree, env={**os.environ, "CARGO_TARGET_DIR": str(target)}, stdout=subprocess.PIPE, text=True)
    if built.returncode:
        sys.exit("the copy does not compile: a slip is no expression where it stands, or has another type")
    programs = {}
    for message in map(json.loads, built.stdout.splitlines()):
        if message.get("executable") and message["profile"]["test"]:
            programs["lib" if "lib" in message["target"]["kind"] else message["target"]["name"]] = message["executable"]
    return programs


class Runner:
    def __init__(self, tree, programs, jobs):
        self.tree, self.programs = tree, programs
        self.threads = max(1, (os.cpu_count() or 1) // jobs)

    def run(self, suite, filters, number, limit=None):
        """Runs tests until one fails. (its name, or why else the suite failed, or None if all pass; seconds)"""
        skipped = LEFT_OUT.get(suite, []) + [name[1:] for name in filters if name[0] == "!"]
        words = [word for name in skipped for word in ("--skip", name)] + [name for name in filters if name[0] != "!"]
        env = {**os.environ, "BDPT_MUTANT": str(number), "BDPT_REQUIRE_GPU": "1", "RUST_BACKTRACE": "0"}
        if number:
            env |= dict.fromkeys(["RUST_TEST_THREADS", "RAYON_NUM_THREADS"], str(self.threads))
        began, late = time.monotonic(), threading.Event()
        process = subprocess.Popen(
            [self.programs[suite], *words], cwd=self.tree, env=env,
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, errors="replace", start_new_session=True,
        )

        def stop():
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

        timer = threading.Timer(limit or 1e6, lambda: (late.set(), stop()))
        timer.start()
        failed = None
        for line in process.stdout:
            found = re.match(r"test (\S+).* \.\.\. FAILED$", line.rstrip())
            if found:
                failed = found[1]
                stop()
                break
        timer.cancel()
        status = process.wait()
        if failed is None and status:
            failed = "(time)" if late.is_set() else f"(status {status})"
        return failed and f"{suite}::{failed}", time.monotonic() - began

    def usual(self, suite, filters):
        """How long these tests take without a slip. They must pass."""
        failed, seconds = self.run(suite, filters, 0)
        print(f"without a slip: {suite} {' '.join(filters)[:60]}: {failed or 'passes'}, {seconds:.0f} s", flush=True)
        if failed:
            sys.exit("a test fails although no slip is made")
        return seconds


ROW = re.compile(r"^\| `([\w-]+)` \|.*\| (?:`(.*)`|\*\*survives\*\*.*) \| (\d+) \|$")


def read_report(path):
    """What a report says: name to (what killed it, seconds)."""
    text = path.read_text() if path.is_file() else ""
    return {row[1]: (row[2], float(row[3])) for row in map(ROW.match, text.splitlines()) if row}


def write_report(path, slips, results, usual, command):
    killed = [slip for slip in slips if results.get(slip["name"], ("", 0))[0]]
    alive = [slip for slip in slips if slip["name"] in results and slip not in killed]
    accepted = [slip for slip in alive if "accepted" in slip]
    by_time = sum(results[slip["name"]][0].endswith("(time)") for slip in killed)
    lines = [
        "# Slips that the suite notices", "",
        f"{datetime.date.today()}, `{command}`, {os.cpu_count()} cores. Made by `run.py`; `slips.json` has what is changed.", "",
        f"**{len(killed)} of {len(killed) + len(alive)} are killed** ({by_time} of them by time), {len(accepted)} of the others are accepted, for the "
        f"reason that stands there. {len(slips) - len(killed) - len(alive)} were not run to the end.", "",
    ]
    if usual:
        lines += ["Without a slip all pass: " + ", ".join(f"{suite} {seconds:.0f} s" for suite, seconds in usual.items()) + ".", ""]
    lines += ["| slip | mistake | file | killed by | s |", "|---|---|---|---|---|"]
    for slip in alive + [slip for slip in slips if slip["name"] not in results] + killed:
        by, seconds = results.get(slip["name"], (None, 0.0))
        verdict = f"`{by}`" if by else "**survives**" if slip in alive else "not run to the end"
        if slip in alive and "accepted" in slip:
            verdict += f", accepted: {slip['accepted']}"
        lines.append(f"| `{slip['name']}` | {slip['mistake'].replace('|', '∣')} | `{slip['file']}` | {verdict} | {seconds:.0f} |")
    path.write_text("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", help="names of slips, with commas between them")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="slips at a time")
    parser.add_argument("--minutes", type=float, default=1e6, help="begin no further stage after so long; what is left counts as not run")
    parser.add_argument("-o", "--output", type=Path, default=HERE / "report.md")
    parser.add_argument("--scratch", type=Path, default=ROOT / "target" / "mutants", help="where the copy lies, and is built unless CARGO_TARGET_DIR is set")
    parser.add_argument("--fresh", action="store_true", help="do not try first what killed a slip before")
    parser.add_argument("--check", action="store_true", help="only ask whether every slip fits its file")
    options = parser.parse_args()
    slips = load_slips()
    names = options.only.split(",") if options.only else [slip["name"] for slip in slips]
    if unknown := set(names) - {slip["name"] for slip in slips}:
        sys.exit(f"there is no {', '.join(sorted(unknown))}")
    print(f"{len(slips)} slips, {sum(map(is_shader, slips))} of them in shaders")
    if options.check:
        return
    tree = options.scratch / "tree"
    write_copy(slips, tree)
    programs = build(tree, Path(os.environ.get("CARGO_TARGET_DIR", options.scratch / "build")).resolve())
    runner, before = Runner(tree, programs, options.jobs), read_report(options.output)
    results = {name: row for name, row in before.items() if options.only and name not in names}
    command = shlex.join(["python3", "tests/mutants/run.py", *sys.argv[1:]])
    left, spent, usual, began = [slip for slip in slips if slip["name"] in names], {}, {}, time.monotonic()

    def run_all(suite, chosen, filters_of, limit):
        """Tries one stage on these slips; keeps what it kills."""
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            running = {pool.submit(runner.run, suite, filters_of(slip), slip["number"], limit): slip for slip in chosen}
            for future in concurrent.futures.as_completed(running):
                slip, (by, seconds) = running[future], future.result()
                spent[slip["name"]] = spent.get(slip["name"], 0.0) + seconds
                if by:
                    left.remove(slip)
                    results[slip["name"]] = by, spent[slip["name"]]
                    print(f"{len(left)} left; {slip['name']}: {by}, {spent[slip['name']]:.0f} s", flush=True)
                    write_report(options.output, slips, results, usual, command)

    # What killed a slip before.
    for suite in SUITES if not options.fresh else []:
        hints = {slip["name"]: (before.get(slip["name"], ("", 0))[0] or "").partition("::") for slip in left}
        hints = {name: test for name, (where, _, test) in hints.items() if where == suite and test[:1] != "("}
        if hints:
            seconds = runner.usual(suite, ["--exact", *sorted(set(hints.values()))])
            run_all(suite, [slip for slip in left if slip["name"] in hints], lambda slip: ["--exact", hints[slip["name"]]], PATIENCE * seconds + GRACE)
    for suite, filters in STAGES:
        chosen = [slip for slip in left if is_judged_by(slip, suite)]
        if not chosen:
            continue
        if time.monotonic() - began > 60.0 * options.minutes:
            break
        seconds = runner.usual(suite, filters)
        usual[suite] = usual.get(suite, 0.0) + seconds
        run_all(suite, chosen, lambda slip: filters, PATIENCE * seconds + GRACE)
    else:
        results.update((slip["name"], (None, spent.get(slip["name"], 0.0))) for slip in left)
    write_report(options.output, slips, results, usual, command)
    alive = [slip["name"] for slip in slips if slip["name"] in names and results.get(slip["name"], ("", 0))[0] is None and "accepted" not in slip]
    sys.exit(f"{len(alive)} survive: {', '.join(alive)}" if alive else 0)


if __name__ == "__main__":
    main()
