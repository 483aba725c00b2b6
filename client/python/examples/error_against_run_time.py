"""Which integrator and time step to use for a scene of my own: the error of each against what it costs.

    python3 error_against_run_time.py my.textproto [--page error.html]
"""

import argparse
from pathlib import Path

import phrenic

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("scene", nargs="?", default="cube-tensegrity", help="a name of the catalogue or a .textproto")
parser.add_argument("--seconds", type=float, default=2)
parser.add_argument("--levels", type=int, default=5, help="time steps per integrator")
parser.add_argument("--page", help="file for the study's page, in HTML")
args = parser.parse_args()

with phrenic.Session(args.scene) as mine:
    study = mine.study.error(seconds=args.seconds, levels=args.levels)
best = study.rows.where(pareto=True)
keep = ("integrator", "time_step_s", "error_rms_mm", "cpu_per_second")
print(phrenic.Table({name: row[name] for name in keep} for row in best))
print(study.advice)
if args.page:
    Path(args.page).write_text(study.page)
