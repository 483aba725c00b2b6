import type { PointReading } from "../gen/phrenic/v1/tissue_pb";
import type { GraphSpec } from "../graphs/catalogue";
import { Signal } from "../state/signal";
import { TimeSeries } from "../state/time_series";
import type { TissueReadings } from "./tissue_queries";

const maxPoints = 6;

/** A place of lung tissue at rest, x y z [m]. */
export type TissuePoint = readonly [number, number, number];

/** The points inside the lungs that this viewer follows, and what was read of them and of the lungs' regions. */
export class TissuePoints {
  readonly all = new Signal<TissuePoint[]>([]);
  readonly readings = new Signal<(PointReading | undefined)[]>([]);
  private readonly displacements = new TimeSeries(120);
  private readonly ventilations = new TimeSeries(120);
  private readonly regions = new TimeSeries(120);

  /** Follows a point; the oldest of more than six is dropped. */
  add(point: TissuePoint): void {
    if (this.all.value.some((each) => pointLabel(each) === pointLabel(point))) return;
    this.change([...this.all.value, point].slice(-maxPoints));
  }

  /** Stops following a point. */
  remove(point: TissuePoint): void {
    this.change(this.all.value.filter((each) => each !== point));
  }

  /** Forgets all points, for another scene. */
  clear(): void {
    this.change([]);
    this.regions.clear();
  }

  /** Records what was read. */
  receive({ time, regions, points }: TissueReadings): void {
    this.regions.add(time, regions);
    if (points.length !== this.all.value.length) return; // asked before the points changed
    this.readings.set(points.map((each) => (each.lung === "" ? undefined : each)));
    const values = (of: (reading: PointReading) => number) =>
      points.map((each, i): [string, number] => [pointLabel(this.all.value[i]), of(each)]);
    this.displacements.add(
      time,
      values(({ dx, dy, dz }) => Math.hypot(dx, dy, dz)),
    );
    this.ventilations.add(
      time,
      values(({ ventilation }) => ventilation),
    );
  }

  /** The graphs of the points and, once read, of the regions. */
  get graphs(): { spec: GraphSpec; history: TimeSeries }[] {
    const points = this.all.value.map(pointLabel);
    return [
      graph("tissue-displacement", "Lung tissue: displacement", "mm", 1e3, points, this.displacements),
      graph("tissue-ventilation", "Lung tissue: volume gained", "%", 100, points, this.ventilations),
      ...this.regionGraphs(),
    ].filter(({ spec }) => spec.curves.length > 0);
  }

  /** A graph for each lung. */
  private regionGraphs(): { spec: GraphSpec; history: TimeSeries }[] {
    const keys = [...this.regions.series.keys()];
    const lungs = [...new Set(keys.map((key) => key.slice(0, key.lastIndexOf(" "))))];
    return lungs.map((lung) => {
      const own = keys.filter((key) => key.startsWith(`${lung} `));
      const names = own.map((key) => key.slice(lung.length + 1));
      return graph(`tissue-${lung}`, `${lung}: volume gained`, "%", 100, own, this.regions, names);
    });
  }

  private change(points: TissuePoint[]): void {
    this.displacements.clear();
    this.ventilations.clear();
    this.readings.set([]);
    this.all.set(points);
  }
}

function graph(
  id: string,
  title: string,
  unit: string,
  factor: number,
  keys: string[],
  history: TimeSeries,
  names = keys,
): { spec: GraphSpec; history: TimeSeries } {
  return { spec: { id, title, unit, curves: keys.map((key, i) => ({ key, name: names[i], factor })) }, history };
}

/** Formats "60, 20, 250". */
export function pointLabel(point: TissuePoint): string {
  return point.map((each) => Math.round(1000 * each)).join(", ");
}

/** Reads "60, 20, 250" [mm]; undefined unless these are three numbers. */
export function pointOf(text: string): TissuePoint | undefined {
  const numbers = text.split(/[\s,;]+/).filter((word) => word !== "");
  const [x, y, z] = numbers.map((word) => Number(word) / 1000);
  return numbers.length === 3 && [x, y, z].every(Number.isFinite) ? [x, y, z] : undefined;
}
