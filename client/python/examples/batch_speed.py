"""What a batch costs beside a loop of sessions, at one thread and at more.

    python3 batch_speed.py [--scene pressure-lungs] [--runs 40] [--threads 1 2]

Efficiency is that of the processors' time, which other programs do not disturb: the time of the runs alone at one thread,
over all that the server used. A wall time says how well the threads were filled, on a machine with nothing else to do.
"""

import argparse
import os
import time

import phrenic

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--scene", default="pressure-lungs")
parser.add_argument("--vary", default="breath_force", help="a live parameter, from 0.5 to 1.5")
parser.add_argument("--runs", type=int, default=40)
parser.add_argument("--seconds", type=float, default=4)
parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
args = parser.parse_args()
parameters = [{args.vary: 0.5 + i / args.runs} for i in range(args.runs)]


def used(server: phrenic.LocalServer) -> float:
    """CPU time of the server so far [s]."""
    with open(f"/proc/{server.process.pid}/stat", encoding="ascii") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def loop(server: phrenic.LocalServer) -> tuple[list[str], float]:
    hashes = []
    for each in parameters:
        with phrenic.Session(args.scene, set=each, server=server) as session:
            *_, last = session.play(args.seconds, fps=20, read=())
            hashes.append(last.state_hash)
    return hashes, 0.0


def batch(server: phrenic.LocalServer, threads: int) -> tuple[list[str], float]:
    runs = list(phrenic.batch(args.scene, parameters, seconds=args.seconds, threads=threads, server=server))
    return [run.state_hash for run in sorted(runs, key=lambda run: run.index)], sum(run.cpu_seconds for run in runs)


with phrenic.local() as server:
    with phrenic.Session(args.scene, server=server):
        pass  # compiles the scene
    rows, expected, alone = [], None, None
    for threads in (0, *args.threads):
        cpu, wall = used(server), time.perf_counter()
        hashes, of_runs = batch(server, threads) if threads else loop(server)
        wall, cpu = time.perf_counter() - wall, used(server) - cpu
        assert expected in (None, hashes), "the bits differ"
        expected, alone = hashes, alone or of_runs or None
        efficiency = alone / cpu if threads and cpu > 0 else float("nan")
        rows.append({"what": f"batch, threads {threads}" if threads else "loop of sessions", "wall_s": wall, "cpu_s": cpu,
                     "efficiency": efficiency})  # fmt: skip
    print(phrenic.Table(rows))
