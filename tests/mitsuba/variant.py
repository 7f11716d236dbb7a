"""Which of Mitsuba's variants renders a scene.

`scalar_rgb` needs nothing else.  What is written in Python (`plugins.py`) is called for every ray
there, some thousand paths a second; `llvm_ad_rgb` compiles it, which takes an LLVM of 17 or newer.
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

# What Mitsuba lacks is the program's own: `export` writes it beside its scenes.
sys.path.append(str(Path(__file__).resolve().parents[2] / "src/report/mitsuba"))

# Dr.Jit takes the first library that it finds, and stops the whole process if that one is too old.
OLDEST_LLVM = 17
PATTERNS = ["/usr/lib/*/libLLVM*.so*", "/usr/lib/libLLVM*.so*", "/usr/lib64/libLLVM*.so*"]


def newest_llvm() -> Path | None:
    """The newest LLVM library that is new enough."""
    found = []
    for pattern in PATTERNS:
        for path in Path("/").glob(pattern[1:]):
            version = re.search(r"libLLVM(?:-|\.so\.)(\d+)", path.name)
            if version and int(version[1]) >= OLDEST_LLVM:
                found.append((int(version[1]), path))
    return max(found)[1] if found else None


LLVM = os.environ.get("DRJIT_LIBLLVM_PATH") or newest_llvm()
if LLVM:
    os.environ["DRJIT_LIBLLVM_PATH"] = str(LLVM)

import mitsuba as mi  # noqa: E402  (it reads the variable)

from gltf import Unusable  # noqa: E402

PLAIN, COMPILED = "scalar_rgb", "llvm_ad_rgb"
mi.set_variant(PLAIN)


def use_plugins() -> None:
    """Switches to the variant in which `plugins.py` is fast, and registers what is in there."""
    if not LLVM:
        raise Unusable(
            f"Mitsuba needs LLVM ≥ {OLDEST_LLVM} for this: apt-get install libllvm19, or set "
            "DRJIT_LIBLLVM_PATH"
        )
    mi.set_variant(COMPILED)
    import plugins  # noqa: F401  (classes of the variant that is set when they are made)


if __name__ == "__main__":
    # Can everything be compared here?
    try:
        use_plugins()
        print(f"Mitsuba {mi.__version__}, {LLVM}")
    except Unusable as error:
        sys.exit(str(error))
