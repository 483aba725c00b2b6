"""How much air a breath moves, against the stiffness of the lungs: forks of one session, one parameter changed in each.

    python3 sensitivity.py [--scene thorax] [--seconds 4]
"""

import argparse

import phrenic

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--scene", default="thorax")
parser.add_argument("--seconds", type=float, default=4)
parser.add_argument("--vary", default="lung_compliance", help="a live parameter")
parser.add_argument("--by", type=float, nargs="+", default=[0.5, 0.75, 1, 1.5, 2])
parser.add_argument("--measure", default="lung volume")
args = parser.parse_args()

with phrenic.Session(args.scene) as patient:
    rows = []
    for factor in args.by:
        with patient.fork(**{args.vary: factor}) as changed:
            volumes = [frame.measures[args.measure] for frame in changed.play(args.seconds, fps=20, read=())]
            rows.append({args.vary: factor, f"range of {args.measure}": max(volumes) - min(volumes)})
    print(phrenic.Table(rows))
