import { Placement } from "../gen/phrenic/v1/frames_pb";
import { type Body, type FrameArrays, positionsOf } from "../geometry/bodies";
import type { Comparison } from "../session/comparisons";
import { NearestSurface } from "../viewer/nearest_surface";

/** Pause after a computation, relative to its duration, so that distances take at most a sixth of the time. */
const timeFactor = 5;

/** The distance of a body from the surface that it was compared with, for the displayed frame. */
export class LiveDistance {
  /** Distance of each vertex [mm]; NaN for a vertex without a triangle. */
  values: ArrayLike<number>;
  private readonly surface: NearestSurface | undefined;
  private shown: FrameArrays | undefined;
  private next = -Infinity;

  constructor(private readonly comparison: Comparison) {
    this.values = comparison.distances;
    if (comparison.surface !== undefined) this.surface = new NearestSurface(comparison.surface);
  }

  /** Computes the distances for `arrays` unless it is too early on a slow machine. Returns true if `values` changed. */
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
