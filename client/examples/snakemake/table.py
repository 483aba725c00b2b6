"""A row a run and measure, from the answers of `phrenic run -o json`. Snakemake defines `snakemake`."""

import csv
import json
from pathlib import Path

parameter = snakemake.params.parameter  # noqa: F821
columns = ["scene", parameter, "measure", "unit", "last", "minimum", "maximum", "cpu_seconds", "state_hash"]
with open(snakemake.output[0], "w", newline="", encoding="utf-8") as file:  # noqa: F821
    table = csv.DictWriter(file, columns, extrasaction="ignore")
    table.writeheader()
    for path in map(Path, snakemake.input):  # noqa: F821
        run = json.loads(path.read_text(encoding="utf-8"))
        of_run = {"scene": path.parent.name, parameter: path.stem, "cpu_seconds": run["cpu_seconds"]}
        for measure in run["measures"] or [{}]:
            table.writerow({**of_run, "state_hash": run.get("state_hash", ""), **measure, "measure": measure.get("name", "")})
