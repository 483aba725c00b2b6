"""Plots as SVG text: lines, bars, bars in three dimensions, and triangle meshes. Standard library only."""
import html
import math

COLOURS = ["#c8553d", "#3f6f9b", "#3f9b64", "#b08900", "#7a4fa3"]
WIDTH, HEIGHT, MARGIN = 460, 260, 46


def svg(body, title, width=WIDTH, height=HEIGHT):
    return (f'<svg viewBox="0 0 {width} {height}" width="{width}" role="img" aria-label="{html.escape(title)}">'
            f"<title>{html.escape(title)}</title>{body}</svg>")


def text(x, y, words, anchor="middle", size=11):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}">{html.escape(words)}</text>'


def ticks(low, high, count=5):
    """Round numbers that cover the interval."""
    if not high > low:
        high = low + 1
    rough = (high - low) / count
    unit = 10 ** math.floor(math.log10(rough))
    step = next(unit * k for k in (1, 2, 5, 10) if unit * k >= rough)
    first = math.ceil(low / step - 1e-9)
    return [step * k for k in range(first, math.floor(high / step + 1e-9) + 1)]


def number(value):
    return f"{value:.6g}"


class Axes:
    """Maps data onto the plot and draws its frame."""

    def __init__(self, xs, ys, x_label, y_label):
        self.x0, self.x1 = min(xs), max(xs)
        low, high = min(ys), max(ys)
        pad = 0.05 * (high - low) or abs(high) or 1
        self.y0, self.y1 = low - pad, high + pad
        self.labels = (x_label, y_label)

    def x(self, value):
        return MARGIN + 14 + (value - self.x0) / ((self.x1 - self.x0) or 1) * (WIDTH - 2 * MARGIN)

    def y(self, value):
        return HEIGHT - MARGIN + 6 - (value - self.y0) / (self.y1 - self.y0) * (HEIGHT - 2 * MARGIN)

    def frame(self):
        parts = []
        for value in ticks(self.x0, self.x1):
            parts.append(text(self.x(value), HEIGHT - MARGIN + 20, number(value)))
        for value in ticks(self.y0, self.y1):
            y = self.y(value)
            parts.append(f'<line x1="{MARGIN + 14}" x2="{WIDTH - MARGIN + 14}" y1="{y:.1f}" y2="{y:.1f}" class="grid"/>')
            parts.append(text(MARGIN + 9, y + 4, number(value), "end"))
        parts.append(text(WIDTH / 2 + 14, HEIGHT - 8, self.labels[0]))
        parts.append(text(MARGIN - 30, 18, self.labels[1], "start"))
        return "".join(parts)


def legend(names):
    return "".join(
        f'<rect x="{WIDTH - 190 + 0}" y="{8 + 15 * i}" width="10" height="10" fill="{COLOURS[i % 5]}"/>'
        + text(WIDTH - 175, 17 + 15 * i, name, "start") for i, name in enumerate(names) if name)


def lines(series, title, x_label, y_label, points=False):
    """A plot of {name: [(x, y), ...]}."""
    every = [point for one in series.values() for point in one]
    axes = Axes([x for x, _ in every], [y for _, y in every], x_label, y_label)
    body = axes.frame()
    for i, one in enumerate(series.values()):
        path = " ".join(f"{axes.x(x):.1f},{axes.y(y):.1f}" for x, y in one)
        body += f'<polyline points="{path}" fill="none" stroke="{COLOURS[i % 5]}" stroke-width="1.5"/>'
        if points:
            body += "".join(f'<circle cx="{axes.x(x):.1f}" cy="{axes.y(y):.1f}" r="3" fill="{COLOURS[i % 5]}"/>'
                            for x, y in one)
    return svg(body + legend(list(series) if len(series) > 1 else []), title)


def bars(groups, title, y_label):
    """Bars of {group: [value of each trial]}; each colour is a trial, as in the thesis."""
    top = max(value for values in groups.values() for value in values)
    axes = Axes([0, len(groups)], [0, top], "", y_label)
    axes.y0 = 0
    body = axes.frame().split(text(axes.x(0), HEIGHT - MARGIN + 20, "0"))[-1]
    body = "".join(text(axes.x(g + 0.5), HEIGHT - MARGIN + 20, name) for g, name in enumerate(groups))
    for value in ticks(0, top):
        y = axes.y(value)
        body += f'<line x1="{MARGIN + 14}" x2="{WIDTH - MARGIN + 14}" y1="{y:.1f}" y2="{y:.1f}" class="grid"/>'
        body += text(MARGIN + 9, y + 4, number(value), "end")
    body += text(MARGIN - 30, 18, y_label, "start")
    for g, values in enumerate(groups.values()):
        for i, value in enumerate(values):
            x = axes.x(g + 0.15 + 0.7 * i / len(values))
            width = axes.x(0.7 / len(values)) - axes.x(0) - 1
            body += (f'<rect x="{x:.1f}" y="{axes.y(value):.1f}" width="{max(width, 1):.1f}" '
                     f'height="{axes.y(0) - axes.y(value):.1f}" fill="{COLOURS[i % 5]}"/>')
    return svg(body, title)


def bars_3d(rows, columns, values, title, z_label):
    """Bars in three dimensions: values[row][column], rows to the back."""
    top = max(max(row) for row in values)

    def at(c, r, z):
        return 70 + 118 * c + 40 * r, 255 - 30 * r - 150 * z / top

    body, labels = text(10, 16, z_label, "start"), ""
    for r in reversed(range(len(rows))):
        for c in range(len(columns)):
            z, colour = values[r][c], COLOURS[r % 5]
            front = [at(c, r, 0), at(c + 0.22, r, 0), at(c + 0.22, r, z), at(c, r, z)]
            side = [at(c + 0.22, r, 0), at(c + 0.22, r + 0.5, 0), at(c + 0.22, r + 0.5, z), at(c + 0.22, r, z)]
            lid = [at(c, r, z), at(c + 0.22, r, z), at(c + 0.22, r + 0.5, z), at(c, r + 0.5, z)]
            for face, opacity in ((lid, 0.6), (side, 0.8), (front, 1)):
                points = " ".join(f"{x:.1f},{y:.1f}" for x, y in face)
                body += f'<polygon points="{points}" fill="{colour}" fill-opacity="{opacity}" stroke="#fff"/>'
            labels += text(*at(c + 0.2, r, z + top * 0.1), number(round(z, 2) if z < 100 else round(z)), size=9)
        labels += text(*at(len(columns) - 0.6, r, 0), rows[r], "start", 10)
    labels += "".join(text(at(c + 0.11, 0, 0)[0], 272, name, size=10) for c, name in enumerate(columns))
    return svg(body + labels, title, 640, 285)


def project(vertices, view):
    """Projects along -y ("front") or obliquely from above ("oblique"); returns (right, up, depth)."""
    if view == "front":
        return [(x, z, y) for x, y, z in vertices]
    return [(x + 0.35 * y, z + 0.25 * y, y) for x, y, z in vertices]


def meshes(parts, title, view="oblique", size=(460, 320)):
    """Draws [(vertices, triangles, lines, style)]; style: {"fill": colour or [colour per triangle], "stroke": colour}."""
    flat = [project(vertices, view) for vertices, *_ in parts]
    every = [point for one in flat for point in one]
    low = [min(point[k] for point in every) for k in (0, 1)]
    high = [max(point[k] for point in every) for k in (0, 1)]
    scale = min((size[0] - 20) / ((high[0] - low[0]) or 1), (size[1] - 20) / ((high[1] - low[1]) or 1))

    def at(point):
        return f"{10 + scale * (point[0] - low[0]):.1f},{size[1] - 10 - scale * (point[1] - low[1]):.1f}"

    body = ""
    for points, (_, triangles, pairs, style) in zip(flat, parts):
        fills = style.get("fill", "none")
        order = sorted(range(len(triangles)), key=lambda t: -sum(points[v][2] for v in triangles[t]))
        for t in order:
            fill = fills if isinstance(fills, str) else fills[t]
            stroke = style.get("stroke") or fill
            corners = " ".join(at(points[v]) for v in triangles[t])
            body += f'<polygon points="{corners}" fill="{fill}" stroke="{stroke}" stroke-width="{style.get("width", 0.4)}"/>'
        for a, b, colour, width in pairs:
            body += f'<polyline points="{at(points[a])} {at(points[b])}" stroke="{colour}" stroke-width="{width}"/>'
    return svg(body, title, *size)


def heat(fraction):
    """A colour from blue (0) over yellow to red (1)."""
    fraction = min(max(fraction, 0), 1)
    return f"hsl({240 - 240 * fraction:.0f} 75% 55%)"
