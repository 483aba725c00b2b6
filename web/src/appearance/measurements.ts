import { type Body, type FrameArrays, positionsOf, vertexAt } from "../geometry/bodies";
import {
  angleAt,
  distanceBetween,
  enclosedVolume,
  isClosed,
  type KeptMeasurement,
  mostMeasurements,
  nearestVertex,
  surfaceArea,
} from "../geometry/measuring";
import type { VertexRef } from "../geometry/vertices";
import { Placement } from "../gen/phrenic/v1/frames_pb";
import type { GraphSpec } from "../graphs/catalogue";
import { Signal } from "../state/signal";
import { TimeSeries } from "../state/time_series";
import { fixed, t } from "../language/translate";

/** A tool: the distance of two points, the angle at the second of three, or the surface of the structure at one. */
export type MeasureTool = "distance" | "angle" | "surface";

/** The points that a tool needs. */
export const pointsOf: Record<MeasureTool, number> = { distance: 2, angle: 3, surface: 1 };

/** What a measurement gives. */
export type Quantity = "distance" | "angle" | "area" | "volume";

const units: Record<Quantity, [unit: string, factor: number]> = {
  distance: ["mm", 1e3],
  angle: ["°", 180 / Math.PI],
  area: ["cm²", 1e4],
  volume: ["ml", 1e6],
};

/** A part of a body: some of its vertices, or all if undefined. */
export interface BodyPart {
  name: string;
  body: string;
  vertices: number[] | undefined;
}

/** A measurement of vertices, which follows their motion. */
export interface Measurement {
  /** Identifies the measurement, and orders its colour. */
  id: number;
  tool: MeasureTool;
  name: string;
  /** The picked vertices; for a surface the one that carries the label. */
  points: VertexRef[];
  /** For a surface: indices of the triangles' vertices, and whether they enclose a volume. */
  surface: { triangles: ArrayLike<number>; closed: boolean; whole: boolean } | undefined;
}

/** The measurements of a scene, their history, and the points that are picked for the next one. */
export class Measurements {
  readonly all = new Signal<Measurement[]>([]);
  /** The active tool; undefined if clicks do not measure. */
  readonly tool = new Signal<MeasureTool | undefined>(undefined);
  /** The points of the next measurement that are picked already. */
  readonly picked = new Signal<VertexRef[]>([]);
  private readonly histories = new Map<Quantity, TimeSeries>();
  private next = 0;
  /** Ids of the measurements that were added last by `replaceKept`. */
  private readonly brought = new Set<number>();
  private bringing = false;

  /** `partAt` returns the structure at a vertex. */
  constructor(
    private readonly bodies: () => Body[],
    private readonly partAt: (ref: VertexRef) => BodyPart,
  ) {}

  /** Chooses a tool, or none; drops the points that are picked. */
  use(tool: MeasureTool | undefined): void {
    this.picked.set([]);
    this.tool.set(tool);
  }

  /** Adds a point for the active tool. The last one that it needs adds the measurement, and the tool stays active. */
  pick(ref: VertexRef): void {
    const tool = this.tool.value;
    if (tool === undefined) return;
    if (tool === "surface") return this.measureSurface(this.partAt(ref), ref.vertex);
    const points = [...this.picked.value, ref];
    this.picked.set(points.length < pointsOf[tool] ? points : []);
    if (points.length === pointsOf[tool]) this.addOfPoints(tool, points);
  }

  private addOfPoints(tool: MeasureTool, points: VertexRef[]): void {
    const name = [...new Set(points.map((each) => this.partAt(each).name))].join(" – ");
    this.add({ tool, name, points, surface: undefined });
  }

  /** Measures the surface of a structure, labelled at `vertex` or its first one. */
  measureSurface({ name, body, vertices }: BodyPart, vertex = vertices?.[0] ?? 0): void {
    const known = this.bodies().find((each) => each.name === body);
    if (known === undefined || known.triangles.length === 0) return;
    const whole = vertices === undefined;
    const triangles = whole ? known.triangles : trianglesWithin(known.triangles, vertices);
    const surface = { triangles, closed: whole && isClosed(known.rest, triangles), whole };
    this.add({ tool: "surface", name, points: [{ body, vertex }], surface });
  }

  /** Removes a measurement. */
  remove(id: number): void {
    this.all.set(this.all.value.filter((each) => each.id !== id));
  }

  /** Removes all measurements and ends measuring. */
  clear(): void {
    this.use(undefined);
    this.all.set([]);
  }

  /** Returns all measurements by places at rest, for a link or a lesson. */
  kept(): KeptMeasurement[] {
    return this.all.value.map(({ tool, points, surface }) => ({
      tool: surface?.whole === true ? "body" : tool,
      points: points.flatMap(({ body, vertex }) => {
        const known = this.bodies().find(({ name }) => name === body);
        if (known === undefined) return [];
        const [x, y, z] = known.rest.subarray(3 * vertex, 3 * vertex + 3);
        return [{ body, rest: [x, y, z] as const }];
      }),
    }));
  }

  /**
   * Adds kept measurements, in place of those that the last call added. Those of bodies that the scene lacks are left
   * out. Measurements of the user stay; beside them there is room for fewer kept ones.
   */
  replaceKept(kept: KeptMeasurement[]): void {
    this.all.set(this.all.value.filter(({ id }) => !this.brought.has(id)));
    this.brought.clear();
    this.bringing = true;
    for (const each of kept) this.addKept(each);
    this.bringing = false;
  }

  private addKept({ tool, points }: KeptMeasurement): void {
    const refs = points.flatMap(({ body, rest }) => {
      const known = this.bodies().find(({ name }) => name === body);
      const vertex = nearestVertex(known?.rest ?? [], rest);
      return vertex < 0 ? [] : [{ body, vertex }];
    });
    if (refs.length < points.length) return;
    const [{ body, vertex }] = refs;
    if (tool === "body") this.measureSurface({ ...this.partAt(refs[0]), body, vertices: undefined }, vertex);
    else if (tool === "surface") this.measureSurface(this.partAt(refs[0]), vertex);
    else this.addOfPoints(tool, refs);
  }

  /** Returns what a measurement gives in a frame, in SI units [m, rad, m^2, m^3]. */
  values({ tool, points, surface }: Measurement, arrays: FrameArrays): [Quantity, number][] {
    const places = this.places(points, arrays);
    if (places.length < points.length) return [];
    if (tool === "distance") return [["distance", distanceBetween(places[0], places[1])]];
    if (tool === "angle") return [["angle", angleAt(places[1], places[0], places[2])]];
    const body = this.bodies().find(({ name }) => name === points[0].body);
    if (body === undefined || surface === undefined) return [];
    // A rigid motion changes neither area nor volume.
    const x = body.placement === Placement.STREAMED ? positionsOf(body, arrays) : body.rest;
    const area: [Quantity, number] = ["area", surfaceArea(x, surface.triangles)];
    return surface.closed ? [area, ["volume", Math.abs(enclosedVolume(x, surface.triangles))]] : [area];
  }

  /** Returns the positions of vertices in a frame [m]; vertices of unknown bodies are left out. */
  places(points: VertexRef[], arrays: FrameArrays): [number, number, number][] {
    return points.flatMap(({ body, vertex }) => {
      const known = this.bodies().find(({ name }) => name === body);
      return known === undefined ? [] : [vertexAt(known, arrays, vertex)];
    });
  }

  /** Records the values at `time` [s]. */
  receive(time: number, arrays: FrameArrays): void {
    const values = new Map<Quantity, [id: string, value: number][]>();
    for (const each of this.all.value) {
      for (const [what, value] of this.values(each, arrays))
        values.set(what, [...(values.get(what) ?? []), [String(each.id), value]]);
    }
    for (const [what, all] of values) {
      const history = this.histories.get(what) ?? new TimeSeries(120);
      this.histories.set(what, history);
      history.add(time, all);
    }
  }

  /** A graph for each quantity that is measured, with its history. */
  get graphs(): { spec: GraphSpec; history: TimeSeries }[] {
    return [...this.histories].flatMap(([what, history]) => {
      const measured = this.all.value.filter(({ id }) => history.series.has(String(id)));
      const [unit, factor] = units[what];
      const curves = measured.map(({ id, name }) => ({ key: String(id), name, factor, order: id }));
      const spec = { id: `measured-${what}`, title: t("Measured {0}", t(what)), unit, curves };
      return curves.length === 0 ? [] : [{ spec, history }];
    });
  }

  /** Adds a measurement. If there are too many, drops the oldest one that `replaceKept` added, else the oldest one. */
  private add(measurement: Omit<Measurement, "id">): void {
    const id = this.next++;
    if (this.bringing) this.brought.add(id);
    const all = [...this.all.value, { ...measurement, id }];
    const dropped = Math.max(
      0,
      all.findIndex((each) => this.brought.has(each.id)),
    );
    this.all.set(all.length > mostMeasurements ? all.toSpliced(dropped, 1) : all);
  }
}

/** Formats a value in SI units: "12.3 mm", "45.0°", "812.4 cm²", "1203 ml". */
export function quantityText(what: Quantity, value: number): string {
  const [unit, factor] = units[what];
  const shown = factor * value;
  if (!Number.isFinite(shown)) return "undefined";
  if (what === "area" && shown < 1) return `${fixed(100 * shown, 1)} mm²`;
  return `${fixed(shown, shown >= 1000 ? 0 : 1)}${what === "angle" ? "" : " "}${unit}`;
}

/** Returns the triangles of which all vertices are among these. */
function trianglesWithin(triangles: Uint32Array, vertices: number[]): number[] {
  const own = new Set(vertices);
  const within: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    const corners = triangles.subarray(t, t + 3);
    if (corners.every((vertex) => own.has(vertex))) within.push(...corners);
  }
  return within;
}
