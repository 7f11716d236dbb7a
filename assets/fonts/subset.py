#!/usr/bin/env python3
"""Makes interface-zh.otf: the Chinese characters and the symbols of the window's own texts, cut out of Noto Sans CJK SC.

    pip install fonttools && python3 assets/fonts/subset.py /usr/share/fonts/opentype/noto/NotoSansCJK-Regular.ttc

(Debian: apt-get install fonts-noto-cjk.) A few symbols that Noto Sans CJK lacks are made from others that it has.
`cargo test --lib fonts` says when this has to be done again.
"""

import pathlib
import sys

from fontTools.fontBuilder import FontBuilder
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.transformPen import TransformPen
from fontTools.ttLib import TTCollection, TTFont

HERE = pathlib.Path(__file__).resolve().parent
SOURCES = sorted(path for part in ("ui", "bdpt", "engine", "report") for path in (HERE.parent.parent / "src" / part).rglob("*.rs"))
SOURCES.append(HERE.parent.parent / "web" / "texts.js")
FAMILY = "Noto Sans CJK SC"
# Symbol: the one it is made from, its size, how far it is lifted (of 1000), and its advance.
MADE = {"⁺": ("+", 0.6, 330, 380), "⁻": ("−", 0.6, 330, 380), "⏷": ("▼", 0.5, 150, 520), "▾": ("▼", 0.5, 150, 520)}


def face(path: str) -> TTFont:
    fonts = TTCollection(path).fonts if path.endswith(".ttc") else [TTFont(path)]
    return next(font for font in fonts if font["name"].getBestFamilyName() == FAMILY)


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    font = face(sys.argv[1])
    names, glyphs, widths = font.getBestCmap(), font.getGlyphSet(), font["hmtx"]
    texts = "".join(source.read_text("utf-8") for source in SOURCES)
    # What egui's own fonts have (Latin, Greek, mathematics) stays theirs: this font is asked last.
    wanted = sorted({c for c in texts if ord(c) >= 0x2000 and (ord(c) in names or c in MADE)})
    charstrings, metrics, cmap = {}, {}, {}

    def add(name: str, source: str, size: float, lift: float, advance: int) -> None:
        pen = T2CharStringPen(advance, glyphs)
        centred = 0.5 * (advance - size * widths[source][0]) if size != 1 else 0
        glyphs[source].draw(TransformPen(pen, (size, 0, 0, size, centred, lift)))
        charstrings[name], metrics[name] = pen.getCharString(), (advance, 0)

    add(".notdef", ".notdef", 1, 0, widths[".notdef"][0])
    for c in wanted:
        name, (source, size, lift, advance) = f"u{ord(c):04X}", MADE.get(c, (c, 1, 0, 0))
        source = names[ord(source)]
        add(name, source, size, lift, advance or widths[source][0])
        cmap[ord(c)] = name
    builder = FontBuilder(font["head"].unitsPerEm, isTTF=False)
    builder.setupGlyphOrder(list(charstrings))
    builder.setupCharacterMap(cmap)
    builder.setupCFF("interface-zh", {"FullName": "Interface ZH"}, charstrings, {})
    builder.setupHorizontalMetrics(metrics)
    builder.setupHorizontalHeader(ascent=font["hhea"].ascent, descent=font["hhea"].descent)
    builder.setupNameTable({
        "copyright": font["name"].getDebugName(0),
        "familyName": "Interface ZH",
        "styleName": "Regular",
        "licenseDescription": "SIL Open Font License, Version 1.1: a part of Noto Sans CJK SC",
        "licenseInfoURL": "http://scripts.sil.org/OFL",
    })
    builder.setupOS2(sTypoAscender=font["OS/2"].sTypoAscender, sTypoDescender=font["OS/2"].sTypoDescender)
    builder.setupPost(keepGlyphNames=False)
    out = HERE / "interface-zh.otf"
    builder.font["head"].created = builder.font["head"].modified = font["head"].modified
    builder.font.recalcTimestamp = False
    builder.save(out)
    print(f"{out.name}: {len(cmap)} characters, {out.stat().st_size} bytes")


if __name__ == "__main__":
    main()
