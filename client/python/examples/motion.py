"""The motion of a body as one numpy array, and lung volume over time as a picture (with matplotlib).

    python3 motion.py [--out motion.npz] [--plot volume.png]
"""

import argparse

import numpy as np
import phrenic

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--scene", default="thorax")
parser.add_argument("--body", default="diaphragm")
parser.add_argument("--measure", default="lung volume")
parser.add_argument("--seconds", type=float, default=8)
parser.add_argument("--fps", type=float, default=20)
parser.add_argument("--out", default="motion.npz")
parser.add_argument("--plot")
args = parser.parse_args()

with phrenic.Session(args.scene) as s:
    frames = list(s.play(args.seconds, fps=args.fps))
times = np.array([frame.time for frame in frames])
positions = np.stack([frame[args.body].positions for frame in frames])
values = np.array([frame.measures[args.measure] for frame in frames])
np.savez(args.out, times=times, positions=positions, values=values, triangles=frames[0][args.body].triangles)
print(f"{args.out}: {positions.shape[0]} frames of {positions.shape[1]} vertices")

if args.plot:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    pyplot.figure(figsize=(6, 3), layout="constrained")
    pyplot.plot(times, values)
    pyplot.xlabel("time [s]")
    pyplot.ylabel(f"{args.measure} [{frames[0].units[args.measure]}]")
    pyplot.savefig(args.plot, dpi=120)
