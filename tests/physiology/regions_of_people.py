#!/usr/bin/python3
"""Prints which part of people's lungs gains air: of landmark pairs of CT (../shared/data/motion/landmarks), the volume
gained [%] in the thirds of the height and of the depth that `phrenic lungs` has.

At each landmark an affine map is fitted to the pairs within 30 mm, weighted by exp(-(d/15 mm)^2); its divergence is the
volume gained there. The lungs are told apart by the widest gap along x near the middle.

usage: regions_of_people.py FILE.csv...
"""
import sys

import numpy as np

REACH, WIDTH, LEAST = 30.0, 15.0, 20  # [mm], [mm], pairs
REGIONS = ("base", "middle", "apex", "back", "front")


def sides(x):
    """Returns masks of the right and the left lung."""
    values = np.sort(x[:, 0])
    middle = (values[0] + values[-1]) / 2
    near = np.flatnonzero(np.abs(values[:-1] - middle) < 40)
    gap = near[np.argmax(values[near + 1] - values[near])]
    cut = (values[gap] + values[gap + 1]) / 2
    return x[:, 0] < cut, x[:, 0] >= cut


def divergence(x, u):
    """Returns the volume gained at each point, NaN where too few are near."""
    gained = np.full(len(x), np.nan)
    for i, point in enumerate(x):
        distance = np.linalg.norm(x - point, axis=1)
        near = np.flatnonzero(distance < REACH)
        if len(near) < LEAST:
            continue
        weight = np.exp(-((distance[near] / WIDTH) ** 2))[:, None]
        design = np.c_[np.ones(len(near)), x[near] - point]
        slopes = np.linalg.lstsq(design * weight, u[near] * weight, rcond=None)[0][1:]
        gained[i] = np.trace(slopes)
    return gained


def regions(x, gained):
    """Returns the mean gain [%] of each region."""
    low, high = np.percentile(x, [0.5, 99.5], axis=0)
    at = (x - low) / (high - low)
    third = np.clip((3 * at[:, 2]).astype(int), 0, 2)
    masks = [third == 0, third == 1, third == 2, at[:, 1] > 2 / 3, at[:, 1] <= 1 / 3]
    return [100 * np.nanmean(gained[mask]) for mask in masks]


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    rows = []
    for path in sys.argv[1:]:
        pairs = np.loadtxt(path, delimiter=",", skiprows=1)
        for name, side in zip(("right", "left"), sides(pairs[:, :3])):
            x = pairs[side, :3]
            rows.append(regions(x, divergence(x, pairs[side, 3:] - x)))
            print(f"{path} {name:5}", " ".join(f"{r} {v:.1f}" for r, v in zip(REGIONS, rows[-1])))
    table = np.array(rows)
    print("mean", " ".join(f"{r} {v:.1f}" for r, v in zip(REGIONS, table.mean(axis=0))))
    for name, ratio in (("base over apex", table[:, 0] / table[:, 2]), ("back over front", table[:, 3] / table[:, 4])):
        print(f"{name}: {ratio.min():.2f} to {ratio.max():.2f}, median {np.median(ratio):.2f}")


if __name__ == "__main__":
    main()
