import { Placement } from "../gen/phrenic/v1/frames_pb";
import { type Body, type FrameArrays, positionsOf } from "../geometry/bodies";
import type { Comparison } from "../session/comparisons";
import { NearestSurface } from "../viewer/nearest_surface";

/** At most one part in so many of the time goes into distances. */
const timeFactor = 5;

/** How far a body is from the surface that it was compared with, at the moment that is shown. */
export class LiveDistance {
  /** [mm] a vertex; NaN for one of no triangle. */
  values: ArrayLike<number>;
  private readonly surface: NearestSurface | undefined;
  private shown: FrameArrays | undefined;
  private next = -Infinity;

  constructor(private readonly comparison: Comparison) {
    this.values = comparison.distances;
    if (comparison.surface !== undefined) this.surface = new NearestSurface(comparison.surface);
  }

  /** Whether the values are others by `arrays`, which are shown at `now` [ms]; a slow machine is asked less often. */
  update(bodies: Body[], arrays: FrameArrays, now: () => number): boolean {
    const { body: name, distances } = this.comparison;
    const body = bodies.find((each) => each.name === name);
    if (this.surface === undefined || body?.placement !== Placement.STREAMED) return false;
    const start = now();
    if (arrays === this.shown || start < this.next) return false;
    this.values = this.surface.distances(positionsOf(body, arrays)).map((mm, i) => mm + 0 * distances[i]);
    this.shown = arrays;
    this.next = now() + timeFactor * (now() - start);
    return true;
  }
}
