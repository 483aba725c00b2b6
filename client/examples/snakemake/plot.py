"""The range of a measure against the parameter, a curve a scene. Snakemake defines `snakemake`."""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

parameter, measure = snakemake.params.parameter, snakemake.params.measure  # noqa: F821
with open(snakemake.input[0], newline="", encoding="utf-8") as file:  # noqa: F821
    everything = list(csv.DictReader(file))
rows = [row for row in everything if row["measure"] == measure]
without = {row["scene"] for row in everything} - {row["scene"] for row in rows}
if without:
    print(f"not in the picture: {', '.join(sorted(without))} without the measure {measure}", file=sys.stderr)
if not rows:
    raise SystemExit(f"no run has the measure {measure}: choose another with --config measure=NAME (runs.csv has all)")


def number(text):
    """The value as a number, or as it is: integrators have names."""
    try:
        return float(text)
    except ValueError:
        return text


figure, axes = pyplot.subplots(figsize=(6, 4), layout="constrained")
for scene in dict.fromkeys(row["scene"] for row in rows):
    points = [(number(row[parameter]), float(row["maximum"]) - float(row["minimum"])) for row in rows if row["scene"] == scene]
    axes.plot(*zip(*points), "o-", label=scene)
axes.set_xlabel(parameter)
axes.set_ylabel(f"range of {measure} [{rows[0]['unit']}]")
axes.legend()
figure.savefig(snakemake.output[0], dpi=120)  # noqa: F821
