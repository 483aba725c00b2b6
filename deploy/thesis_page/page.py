#!/usr/bin/env python3
"""Writes one page with the figures and tables of chapters 4 and 5 of the thesis: page.py FOLDER OUT.html

FOLDER has what deploy/thesis lets `phrenic` write. Every figure has ours beside the thesis' numbers, the ratio where
there are numbers, and a sentence on what agrees and what does not. What needs the patient's CT is named.
"""
import html
import math
import pathlib
import sys

import data
import drawing

SIZES = ("High", "Medium", "Low")
STYLE = """body{font:15px/1.45 system-ui,sans-serif;max-width:1000px;margin:2rem auto;padding:0 1rem;color:#222}
svg{background:#fff;max-width:100%}.grid{stroke:#e3e6ea}.pair{display:flex;flex-wrap:wrap;gap:1rem}
table{border-collapse:collapse;margin:.6rem 0}th,td{padding:.2rem .6rem;border-bottom:1px solid #d5d9de;text-align:right}
th:first-child,td:first-child{text-align:left}.verdict{background:#f4f1e8;padding:.4rem .7rem;border-left:4px solid #b08900}
section{margin:2.2rem 0}svg text{fill:#333}"""


def mean(values):
    return sum(values) / len(values)


def table(head, rows):
    def row(cells, tag):
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"

    return "<table>" + row(head, "th") + "".join(row(cells, "td") for cells in rows) + "</table>"


def section(figure, what, body, verdict):
    return (f'<section id="f{figure.split("-")[0].replace(".", "-")}"><h2>{html.escape(figure)}: {html.escape(what)}</h2>'
            f'<div class="pair">{body}</div><p class="verdict">{html.escape(verdict)}</p></section>')


def missing(figure, what, why):
    return section(figure, what, "", f"Not made: {why}")


def digits(value):
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:,.0f}"


class Runs:
    """What deploy/thesis has recorded."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)

    def csv(self, name):
        return data.columns(self.folder / f"{name}.csv")

    def obj(self, name):
        return data.surface(self.folder / f"{name}.obj")

    def cost(self, name):
        path = self.folder / f"{name}.json"
        return data.study(path) if path.exists() else None


# --- chapter 4 and 5.1 to 5.9 ---


def edges_of(triangles):
    return {tuple(sorted((t[i], t[(i + 1) % 3]))) for t in triangles for i in range(3)}


def network(runs):
    links = [(a, a + 18) for a in range(19, 26)]
    parts = []
    for name in ("sheet-rest", "sheet-pushed"):
        vertices, triangles, edges = runs.obj(name)
        pairs = [(a, b, "#3f9b64", 1) for a, b in sorted(edges_of(triangles) | set(edges))]
        parts.append(drawing.meshes([(vertices, [], pairs + [(a, b, "#c0392b", 3) for a, b in links], {})], name, "front"))
    return section("4.4", "the planar network, thin tensile and thick rigid connections (at rest, and pushed)", "".join(parts),
                   "Agrees in kind: a planar network of springs with rigid links, at its own size; the thesis prints no "
                   "numbers of it.")


def breathing(runs):
    series = {}
    for force, length in ((1, 4), (2, 4), (1, 8)):
        series[f"force {force}, length {length} s"] = [
            (t / 50, force * math.sin(2 * math.pi * t / 50 / length)) for t in range(401)]
    motion = runs.csv("breath")
    low, high = min(motion["right summit z [mm]"]), max(motion["right summit z [mm]"])
    ours = list(zip(motion["time [s]"], motion["right summit z [mm]"]))
    body = drawing.lines(series, "Equation 4.1", "time [s]", "y / C1")
    body += drawing.lines({"right summit": ours}, "Height of the right dome", "time [s]", "z [mm]")
    return section("4.8", "breathing motion", body,
                   f"Equation 4.1 is offered as the sine waveform (left). The shipped thorax breathes by a raised cosine, "
                   f"which never pushes the dome above its rest: it moves by {high - low:.1f} mm (right).")


def cube_edges(vertices_links):
    springs = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    pairs = [(a, b, "#3f9b64", 1.5) for a, b in springs]
    return pairs + [(a, b, "#c0392b", 3) for a, b in vertices_links]


LINKS = [(0, 5), (1, 6), (2, 7), (3, 4)]


def cube(runs):
    vertices, _, _ = runs.obj("cube-tensegrity-0")
    body = drawing.meshes([(vertices, [], cube_edges(LINKS), {})], "The tensegrity cube", size=(300, 260))
    return section("5.1", "the tensegrity cube", body, "Agrees: 10 m, twelve springs, four diagonal rigid links between "
                   "the squares.")


def evolution(runs):
    body = ""
    for scene, links in (("cube-springs", []), ("cube-tensegrity", LINKS)):
        for t in range(4):
            vertices, _, _ = runs.obj(f"{scene}-{t}")
            body += drawing.meshes([(vertices, [], cube_edges(links), {})], f"{scene} at {t} s", size=(225, 200))
    return section("5.2", "the cubes at 0, 1, 2 and 3 s: springs above, tensegrity below", body,
                   "Agrees: two upper vertices move with a sine; the springs fold, the rigid links keep the height.")


def height_of(runs, name):
    motion = runs.csv(name)
    return list(zip(motion["time [s]"], [z / 1000 for z in motion["p z [mm]"]]))


def mass_p(runs):
    springs, tensegrity, thesis = (height_of(runs, name) for name in ("cube-springs", "cube-tensegrity", "cube-thesis"))
    span = {name: (min(z for _, z in one), max(z for _, z in one))
            for name, one in (("springs", springs), ("tensegrity", tensegrity), ("thesis", thesis))}
    body = drawing.lines({"springs": springs}, "Mass p with springs", "time [s]", "height [m]")
    body += drawing.lines({"tensegrity": tensegrity}, "Mass p with tensegrity", "time [s]", "height [m]")
    body += drawing.lines({"springs, the thesis' integrator": thesis}, "Mass p, integrator=thesis", "time [s]", "height [m]")
    words = {name: f"{low:.2f} to {high:.2f} m" for name, (low, high) in span.items()}
    collapses = span["springs"][0] < 5
    return section("5.3", "height of mass p: springs left, tensegrity right", body,
                   f"{'Agrees' if collapses else 'Does not agree'}: springs {words['springs']}, tensegrity "
                   f"{words['tensegrity']}. Does not agree with integrator=thesis: with the thesis' own scheme and "
                   f"damping of 0.02 a step, the springs cube does not collapse ({words['thesis']}); the thesis' "
                   f"stiffness and masses are not printed.")


def difference(runs, force):
    with_links, without = runs.csv(f"links-{force}-with"), runs.csv(f"links-{force}-without")
    name = "right summit z [mm]"
    return [(i, a - b) for i, (a, b) in enumerate(zip(with_links[name], without[name]))][:201]


def rigid_links(runs):
    weak, strong = difference(runs, "weak"), difference(runs, "strong")
    largest = [max(abs(y) for _, y in one) for one in (weak, strong)]
    slopes = [sum(1 for i in range(2, len(one)) if (one[i][1] - one[i - 1][1]) * (one[i - 1][1] - one[i - 2][1]) < 0)
              for one in (weak, strong)]
    body = drawing.lines({"": weak}, "Weak forces", "recorded time, 10 ms each", "difference [mm]")
    body += drawing.lines({"": strong}, "Forces ten times as strong", "recorded time, 10 ms each", "difference [mm]")
    ratio = largest[1] / largest[0] if largest[0] else math.inf
    return section("5.4-5.6", "height of the right dome with rigid links minus without, weak and tenfold", body,
                   f"Largest difference {digits(largest[0])} mm at weak forces and {digits(largest[1])} mm at ten times "
                   f"the forces, {digits(ratio)} times as much; the curves turn {slopes[0]} and {slopes[1]} times. The "
                   f"thesis prints no scale: it shows a steady rise, then troughs and hills. The chosen node (5.4) is the "
                   f"top of the right dome here.")


def ghost(runs):
    inhale, exhale = runs.obj("end-of-inhale"), runs.obj("end-of-exhale")
    body = drawing.meshes([(exhale[0], exhale[1], [], {"fill": "#e0a090", "stroke": "#c8553d", "width": 0.2}),
                           (inhale[0], inhale[1], [], {"stroke": "#3f6f9b", "width": 0.25})],
                          "End of an exhale in colour, end of an inhale as wireframe", "front", (640, 380))
    top = [max(z for _, _, z in one[0]) for one in (inhale, exhale)]
    return section("5.7", "the motion: end of an inhale as wireframe, end of an exhale in colour", body,
                   f"Agrees in kind: the domes rise by {top[1] - top[0]:.1f} mm and keep their shape, the sides follow "
                   f"the ribs. The reference model is not ours: the mesh is generated.")


def distance_maps(runs):
    body, largest = "", []
    for name, what in (("map-rest", "end of inhale from end of exhale"), ("map-links", "end of inhale from the same without links")):
        vertices, triangles, values = data.distances(runs.folder / f"{name}.msh")
        top = max(values)
        largest.append(top)
        fills = [drawing.heat(sum(values[v] for v in t) / 3 / (top or 1)) for t in triangles]
        body += drawing.meshes([(vertices, triangles, [], {"fill": fills, "width": 0.2})],
                               f"{what}: 0 (blue) to {top:.2f} mm (red)", "front")
    return section("5.9", "distance maps: blue 0, red the largest distance", body,
                   f"Not comparable: both of the thesis' maps are measured to the patient's CT, which is not published. "
                   f"Ours: left, the end of inhale from the end of exhale, up to {largest[0]:.1f} mm; right, from the same "
                   f"simulation without rigid links, up to {largest[1]:.2f} mm.")


# --- 5.10 to 5.27 ---


def trials(cost, variant, iterations):
    """Seconds of the trials of a variant for so many iterations."""
    return [1e-6 * row["cpu_us_per_step"] * iterations for row in cost["trials"] if row["variant"] == variant]


def trial_table(ours, thesis):
    names = [name for name in thesis if ours.get(name)]
    head = ["[s]"] + [f"{name}, {who}" for name in names for who in ("thesis", "ours")]
    rows = []
    for i in range(5):
        rows.append([f"Trial {i + 1}"] + [f"{one[name][i]:.4g}" if i < len(one[name]) else "-"
                                          for name in names for one in (thesis, ours)])
    rows.append(["Average"] + [f"{mean(one[name]):.4g}" for name in names for one in (thesis, ours)])
    rows.append(["thesis/ours"] + [cell for name in names for cell in ("", digits(mean(thesis[name]) / mean(ours[name])))])
    return table(head, rows)


def timed(figure, plot, what, ours, thesis, verdict):
    ours = {name: ours[name] for name in thesis if ours.get(name)}
    if not ours:
        return missing(f"{figure}-{plot}", what, "the study of the cost left these sizes out; run deploy/thesis with more time.")
    body = trial_table(ours, thesis) + drawing.bars(thesis, f"{plot}: the thesis", "[s]")
    body += drawing.bars(ours, f"{plot}: ours", "[s]")
    return section(f"{figure}-{plot}", what, body, verdict(ours))


def ratio_words(ours, thesis):
    ratios = [mean(thesis[name]) / mean(ours[name]) for name in ours]
    return f"Ours takes 1/{digits(min(ratios))} to 1/{digits(max(ratios))} of the thesis' time (another machine, 2008)"


def percent(with_part, without):
    return 100 * (mean(with_part) / mean(without) - 1)


def cubes(cost):
    ours = {"Tensegrity": trials(cost, "cube", 1e5), "Tensile": trials(cost, "cube, without links", 1e5)}
    row = cost["sizes"][0]

    def verdict(found):
        return (f"{ratio_words(found, data.THESIS['5.10'])}. Rigid links cost {row['links_cost_percent']:.0f} % "
                f"({row['links_cost_least_percent']:.0f} to {row['links_cost_most_percent']:.0f} % in single trials), in "
                f"the thesis 27 %: does not agree, because a step of springs alone has become cheaper than the links.")

    return timed("5.10", "5.11", "the cubes, 100,000 iterations", ours, data.THESIS["5.10"], verdict)


def parts(cost):
    ours = {"Full": trials(cost, "full", 100), "No attachment": trials(cost, "without attachments", 100),
            "No rib kinematics": trials(cost, "without ribs", 100)}

    def verdict(found):
        words = [f"without {what} {digits(-percent(found[name], found['Full']))} % less (thesis "
                 f"{digits(-percent(data.THESIS['5.12'][name], data.THESIS['5.12']['Full']))} %)"
                 for name, what in (("No attachment", "attachments"), ("No rib kinematics", "ribs")) if name in found]
        return (f"{ratio_words(found, data.THESIS['5.12'])}; {', '.join(words)}. Agrees in order; our ribs are cheaper, "
                f"since they move as rigid bodies.")

    return timed("5.12", "5.13", "the diaphragm, 100 iterations, with parts left out", ours, data.THESIS["5.12"], verdict)


def sizes(cost, links):
    suffix = "" if links else ", without links"
    return {size: trials(cost, f"perfect model, {size.lower()}{suffix}", 100) for size in SIZES}


def resized(cost, links, figure, plot):
    what = "three meshes of the perfect model, 100 iterations, " + ("with rigid links" if links else "without rigid links")

    def verdict(found):
        present = [size for size in SIZES if size in found]
        growth = mean(found[present[0]]) / mean(found[present[-1]])
        theirs = mean(data.THESIS[figure][present[0]]) / mean(data.THESIS[figure][present[-1]])
        if len(present) == 1:
            return f"{ratio_words(found, data.THESIS[figure])}. The larger sizes were left out for time."
        return (f"{ratio_words(found, data.THESIS[figure])}. From {present[-1]} to {present[0]} the time grows {growth:.2f} "
                f"times (thesis {theirs:.2f}): agrees that it is about linear in the vertices.")

    return timed(figure, plot, what, sizes(cost, links), data.THESIS[figure], verdict)


def patient(cost, links, figure, plot):
    what = "three meshes of the patient model, " + ("with rigid links" if links else "without rigid links")
    if cost is None:
        rows = [[f"Trial {i + 1}"] + [data.THESIS[figure][size][i] for size in SIZES] for i in range(5)]
        return section(f"{figure}-{plot}", what, table(["thesis [s]", *SIZES], rows),
                       "Not made: the meshes come from the patient's CT, which is not published.")
    ours = {size: trials(cost, f"patient model, {size.lower()}" + ("" if links else ", without links"), 100) for size in SIZES}
    return timed(figure, plot, what, ours, data.THESIS[figure], lambda found: ratio_words(found, data.THESIS[figure]) + ".")


def growth(cost, links, figure):
    ours = sizes(cost, links)
    theirs = data.THESIS["5.16" if links else "5.21"]
    counted = {row["variant"]: int(row["vertices"]) for row in cost["trials"]}
    suffix = "" if links else ", without links"
    points = sorted((counted[f"perfect model, {size.lower()}{suffix}"], mean(ours[size])) for size in SIZES if ours[size])
    if len(points) < 2:
        return missing(figure, "time against vertices", "the study of the cost left the sizes out.")
    thesis = sorted((data.VERTICES["patient"][size], mean(theirs[size])) for size in SIZES)
    exponents = [math.log(one[-1][1] / one[0][1]) / math.log(one[-1][0] / one[0][0]) for one in (points, thesis)]
    body = drawing.lines({"": thesis}, "the thesis' patient", "vertices", "[s]", True)
    body += drawing.lines({"": points}, "ours, generated", "vertices", "[s]", True)
    return section(figure, "time against vertices, " + ("with" if links else "without") + " rigid links", body,
                   f"Agrees: time grows as vertices^{exponents[0]:.2f} (the thesis' patient: ^{exponents[1]:.2f}). Ours is the "
                   f"generated thorax, since the patient's meshes are not published.")


def rates(cost, others):
    """Iterations per second by size: with links, without, rib kinematics only, diaphragm only (None if not measured)."""
    found = {}
    for size in SIZES:
        row = [sizes(cost, True)[size], sizes(cost, False)[size]]
        study = others.get(size)
        row += [trials(study, name, 100) if study else [] for name in ("without muscles", "without ribs")]
        found[size] = [100 / mean(values) if values else None for values in row]
    return found


CASES = ["All forces, links", "All forces, no links", "Rib kinematics only", "Diaphragm only"]


def summary(cost, others):
    ours = rates(cost, others)
    rows = []
    for i, case in enumerate(CASES):
        cells = [case]
        for theirs, own in ((data.RATES[size][i], ours[size][i]) for size in SIZES):
            cells += [theirs, digits(own) if own else "-", digits(own / theirs) if own else "-"]
        rows.append(cells)
    head = ["Perfect model"] + [f"{size}: {who}" for size in SIZES for who in ("thesis", "ours", "ratio")]
    ratios = [own / theirs for size in SIZES for own, theirs in zip(ours[size], data.RATES[size]) if own]
    words = f"{digits(min(ratios))} to {digits(max(ratios))} times the iterations per second" if ratios else "not measured"
    return section("5.24", "iterations per second", table(head, rows),
                   f"{words} of the thesis, whose meshes have {', '.join(str(data.VERTICES['perfect'][s]) for s in SIZES)} "
                   f"vertices. The patient's rows (6.37 to 19.69) need its CT.")


def in_three_dimensions(cost, others):
    ours = rates(cost, others)
    present = [i for i in range(4) if all(ours[size][i] for size in SIZES)]
    body = drawing.bars_3d(SIZES, [CASES[i] for i in range(4)], [data.RATES[size] for size in SIZES], "5.25: the thesis", "1/s")
    if not present:
        return section("5.25", "iterations per second, in three dimensions", body, "Ours was not measured.")
    values = [[ours[size][i] for i in present] for size in SIZES]
    body += drawing.bars_3d(SIZES, [CASES[i] for i in present], values, "5.25: ours", "1/s")
    fastest = max(present, key=lambda i: ours["High"][i])
    return section("5.25", "iterations per second, in three dimensions", body,
                   f"Agrees that smaller meshes are faster. Fastest with '{CASES[fastest]}' here, with 'Diaphragm only' in "
                   f"the thesis.")


def patient_in_three_dimensions():
    body = drawing.bars_3d(SIZES, CASES[:2], [data.PATIENT_RATES[size] for size in SIZES], "5.26: the thesis", "1/s")
    return section("5.26", "iterations per second of the patient, in three dimensions", body,
                   "Ours is not made: the patient's meshes come from its CT.")


def links_cost(cost):
    rows = []
    for row in cost["sizes"]:
        size = row["what"].split(", ")[-1].capitalize()
        count, theirs = data.LINKS[size]
        rows.append([size, row["vertices"], f"{row['links']} ({count})", f"{row['links_cost_percent']:.2f} %",
                     f"{row['links_cost_least_percent']:.2f} to {row['links_cost_most_percent']:.2f} %", f"{theirs} %",
                     digits(row["links_cost_percent"] / theirs)])
    rows += [[f"Patient, {size}", data.VERTICES["patient"][size], f"({count})", "-", "-", f"{theirs} %", "-"]
             for size, (count, theirs) in data.PATIENT_LINKS.items()]
    head = ["Model", "Vertices", "Links (thesis)", "Cost of links", "in single trials", "thesis", "ratio"]
    return section("5.27", "cost of the rigid links", table(head, rows),
                   f"{links_words([row['links_cost_percent'] for row in cost['sizes']])} The thesis' rates of the patient "
                   "here differ from those of its figure 5.24; the patient's meshes need its CT.")


def links_words(ours):
    theirs = [percent for _, percent in data.LINKS.values()]
    words = (f"Links cost {digits(min(ours))} to {digits(max(ours))} % of a step here, {min(theirs)} to {max(theirs)} % in the "
             "thesis")
    if max(ours) <= 1.5 * max(theirs):
        return f"Agrees: {words}."
    return f"{words}: more of a step whose springs have become cheaper, and little in both."


def page(folder):
    runs = Runs(folder)
    cube_cost, cost, patient_cost = (runs.cost(name) for name in ("cost-cube", "cost-thorax", "cost-patient"))
    others = {size: runs.cost(f"cost-{size.lower()}") for size in SIZES}
    return "".join([
        network(runs), breathing(runs), cube(runs), evolution(runs), mass_p(runs), rigid_links(runs), ghost(runs),
        missing("5.8", "the segmented diaphragm inside the CT", "the patient's CT is not published; `phrenic patient` makes "
                "the same from a segmented volume."),
        distance_maps(runs), cubes(cube_cost), parts(cost), resized(cost, True, "5.14", "5.15"),
        patient(patient_cost, True, "5.16", "5.17"), growth(cost, True, "5.18"), resized(cost, False, "5.19", "5.20"),
        patient(patient_cost, False, "5.21", "5.22"), growth(cost, False, "5.23"), summary(cost, others),
        in_three_dimensions(cost, others), patient_in_three_dimensions(), links_cost(cost)])


def main():
    folder, out = sys.argv[1:]
    body = page(folder)
    notes = "".join(f"<p>{html.escape(note)}</p>" for name in ("cost-cube", "cost-thorax")
                    for note in (Runs(folder).cost(name) or {}).get("notes", []))
    pathlib.Path(out).write_text(
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>The thesis, made again</title><style>{STYLE}</style>'
        "<h1>Chapters 4 and 5 of the thesis, made again</h1><p>Left or first the thesis' numbers, then ours. Figures 4.1 to "
        f"4.3, 4.5 to 4.7 and table 4.1 show programs and formats and have no result.</p>{notes}{body}</html>\n")


if __name__ == "__main__":
    main()
