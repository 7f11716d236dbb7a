"""Do two sets of independent pictures have the same expectation?

The means over the whole picture (of R, G, B and their mean) must agree at a joint level, and no
block of 16×16 pixels may differ by more than 4.5 standard errors.  Every figure comes with the
error that would have been found.
"""

from __future__ import annotations

from statistics import NormalDist

import numpy as np

# RGB: the mean of the three.
QUANTITIES = ["RGB", "red", "green", "blue"]
# Side of a block, pixels, and the most standard errors it may be off.
BLOCK = 16
BLOCK_LIMIT = 4.5
# Level of the test of the means over the whole picture, all four together.
LEVEL = 0.999
MEAN_LIMIT = NormalDist().inv_cdf(1 - (1 - LEVEL) / (2 * len(QUANTITIES)))
# Both sum float32: differences below this share of a value are rounding, not errors.
ROUNDING = 1e-5
# An error of the size called "seen" is found with this probability.
POWER = 0.9
# A comparison that would miss an error of this share of the mean says nothing.
LARGEST_SEEN = 0.02


def judge(ours: np.ndarray, theirs: np.ndarray) -> dict:
    """Figures of two sets of pictures, [seed, y, x, channel], and AGREE, FAILED or UNDECIDED."""
    whole = compare(average(ours, None), average(theirs, None), MEAN_LIMIT)
    blocks = compare(average(ours, BLOCK), average(theirs, BLOCK), BLOCK_LIMIT)
    rows = [
        {"quantity": name, "mean": picture_row(whole, i), "block": block_row(blocks, i)}
        for i, name in enumerate(QUANTITIES)
    ]
    reasons = []
    for what, figures, limit in (("means", whole, MEAN_LIMIT), ("blocks", blocks, BLOCK_LIMIT)):
        beyond = ~(np.abs(figures["sigma"]) <= limit)
        if beyond.any():
            worst = np.abs(figures["sigma"]).max()
            count = f"{beyond.sum()} of {beyond.size} {what}, channels counted"
            reasons.append(f"{count}, differ by up to {worst:.1f} sigma")
    for who, pictures in (("our", ours), ("Mitsuba's", theirs)):
        wrong = np.sum(~np.isfinite(pictures))
        if wrong:
            reasons.append(f"{wrong} of {who} values are not finite")
    verdict = "FAILED" if reasons else "AGREE"
    if not reasons and not rows[0]["mean"]["seen"] <= LARGEST_SEEN:
        verdict = "UNDECIDED"
        reasons = ["the picture is black or too noisy: raise --spp or --seeds"]
    return {
        "limits": [MEAN_LIMIT, BLOCK_LIMIT],
        "rows": rows,
        "verdict": verdict,
        "reasons": reasons,
    }


def picture_row(whole: dict, i: int) -> dict:
    """The figures of a quantity over the whole picture."""
    return {key: float(value[0, 0, i]) for key, value in whole.items()}


def block_row(blocks: dict, i: int) -> dict:
    """A quantity in its worst block; "seen" is the median of all blocks that are not black."""
    sigma, seen = np.abs(blocks["sigma"][..., i]), blocks["seen"][..., i]
    y, x = np.unravel_index(np.argmax(sigma), sigma.shape)
    row = {key: float(value[y, x, i]) for key, value in blocks.items()}
    seen = seen[np.isfinite(seen)]
    return {
        **row,
        "pixel": [int(x) * BLOCK, int(y) * BLOCK],
        "seen": float(np.median(seen)) if seen.size else float("inf"),
    }


def average(pictures: np.ndarray, side: int | None) -> np.ndarray:
    """Means over blocks of `side`², or over everything: [seed, row, column, quantity].

    The last blocks of a row and of a column may be smaller.
    """
    full = np.concatenate([pictures.mean(axis=-1, keepdims=True), pictures], axis=-1)
    if side is None:
        return full.mean(axis=(1, 2), keepdims=True)
    sums, area = full, np.ones(full.shape[1:3])[None, :, :, None]
    for axis in (1, 2):
        edges = np.arange(0, full.shape[axis], side)
        sums, area = np.add.reduceat(sums, edges, axis), np.add.reduceat(area, edges, axis)
    return sums / area


def compare(ours: np.ndarray, theirs: np.ndarray, limit: float) -> dict:
    """Are the expectations of these independent estimates (axis 0: seeds) equal, each by itself?

    The variance of a block is that of its mean from seed to seed.  To pool the variances of its
    pixels would give more degrees of freedom but would take pixels for independent, which they
    are not: one light subpath splats into several of them.  What few seeds cost is accounted for
    instead: Welch's t has Student's distribution with the degrees of freedom that the two sample
    variances give, and `sigma` is the normal deviate of the same tail probability.
    """
    ours_mean, theirs_mean = ours.mean(axis=0), theirs.mean(axis=0)
    a, b = (x.var(axis=0, ddof=1) / len(x) for x in (ours, theirs))
    with np.errstate(divide="ignore", invalid="ignore"):
        dof = (a + b) ** 2 / (a**2 / (len(ours) - 1) + b**2 / (len(theirs) - 1))
        dof = np.where(np.isfinite(dof), dof, min(len(ours), len(theirs)) - 1)
        error = np.sqrt(
            a + b + (ROUNDING * np.maximum(np.abs(ours_mean), np.abs(theirs_mean))) ** 2
        )
        difference = ours_mean - theirs_mean
        t = np.where(difference == 0, 0, difference / error)
        relative = np.where(difference == 0, 0, difference / theirs_mean)
        # The true error that is found with probability POWER, relative to the mean.
        seen = (
            (student_from_normal(limit, dof) + NormalDist().inv_cdf(POWER)) * error / theirs_mean
        )
    return {
        "ours": ours_mean,
        "mitsuba": theirs_mean,
        "relative": relative,
        "sigma": normal_from_student(t, dof),
        "seen": np.where(np.isnan(seen), np.inf, seen),
    }


def normal_from_student(t, dof):
    """The normal deviate with the tail probability of Student's t.

    Wallace's approximation (1959): for dof ≥ 15 and up to 6 sigma it is right within 0.4 %.
    """
    return np.sign(t) * (8 * dof + 1) / (8 * dof + 3) * np.sqrt(dof * np.log1p(t * t / dof))


def student_from_normal(z, dof):
    """The inverse of `normal_from_student`."""
    return np.sqrt(dof * np.expm1((z * (8 * dof + 3) / (8 * dof + 1)) ** 2 / dof))
