import type { Api } from "../connection/api";
import type { Body } from "../geometry/bodies";
import type { Marker } from "../geometry/vertices";
import { curveColor } from "../graphs/colors";
import { LungTissue } from "./lung_tissue";
import { TissuePoints } from "./tissue_points";

/** The lungs' tissue of the first view, and the points inside them that it follows. */
export class LungTools {
  readonly tissue: LungTissue;
  readonly points = new TissuePoints();

  constructor(api: Api, sessionId: string) {
    this.tissue = new LungTissue(api, sessionId);
    this.tissue.queries.readings.subscribe((read) => read && this.points.receive(read));
  }

  /** Starts another scene. */
  start(bodies: Body[]): void {
    this.tissue.start(bodies);
    this.points.clear();
  }

  /** Reads the tissue if it is shown or followed. `seen` identifies the state that the viewer received last. */
  query(shown: boolean, seen: string): void {
    if (shown || this.points.all.value.length > 0) void this.tissue.queries.query(this.points.all.value, seen);
  }

  /** Follows the tissue that is at a place now, in one of the lungs [m]. */
  follow([x, y, z]: [number, number, number]): void {
    for (const { name, rest } of this.tissue.lungBodies) {
      if (!isInBox(rest, x)) continue;
      const point = this.tissue.restOf(name, x, y, z);
      if (point !== undefined)
        return this.points.add(point.map((each) => Math.round(1e3 * each) / 1e3) as typeof point);
    }
  }

  /** Returns markers of the followed points in the displayed frame. */
  markers(): Marker[] {
    return this.points.all.value.flatMap((point, i) => {
      const lung = this.points.readings.value[i]?.lung;
      const position = lung === undefined ? undefined : this.tissue.nowOf(lung, point);
      return position === undefined ? [] : [{ position, color: curveColor(i), unclipped: true }];
    });
  }
}

/** True if x is in the range of a lung: the lungs lie side by side. */
function isInBox(rest: Float32Array, x: number): boolean {
  let [low, high] = [Infinity, -Infinity];
  for (let i = 0; i < rest.length; i += 3) [low, high] = [Math.min(low, rest[i]), Math.max(high, rest[i])];
  return x > low - 0.01 && x < high + 0.01;
}
