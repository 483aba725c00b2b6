import { scaleLinear } from "d3-scale";
import { interpolateViridis } from "d3-scale-chromatic";

/** A mark beside the scale: how far along it, 0 to 1, and its words. */
export interface Tick {
  part: number;
  text: string;
}

/** The least length that a scale ends at [mm]: below it surfaces are the same. */
const leastTop = 0.001;
const steps = 256;
/** Where the colour map is entered: its first colours are lost on a dark ground. */
const start = 0.12;
/** The colour of a vertex that has no distance. */
const unknown: [number, number, number] = [128, 136, 146];

/** The end of a scale that shows all of these distances [mm]: their largest, rounded up. */
export function topFor(distances: readonly number[]): number {
  const largest = distances.reduce((most, each) => (each > most ? each : most), leastTop);
  return scaleLinear([0, largest], [0, 1]).nice(5).domain()[1];
}

/** Colours for distances from 0 to `top` [mm]: equal differences look equally large, also to the colour-blind. */
export class DistanceScale {
  private readonly table: [number, number, number][];

  constructor(readonly top: number) {
    this.table = Array.from({ length: steps }, (_, i) =>
      bytesOf(interpolateViridis(start + (1 - start) * (i / (steps - 1)))),
    );
  }

  /** About five. */
  ticks(): Tick[] {
    const scale = scaleLinear([0, this.top], [0, 1]);
    const words = scale.tickFormat(5);
    return scale.ticks(5).map((value) => ({ part: scale(value), text: words(value) }));
  }

  /** sRGB of a distance [mm]; what is beyond the scale has its last colour. */
  color(distance: number): [number, number, number] {
    if (Number.isNaN(distance)) return unknown;
    const step = Math.round((distance / this.top) * (steps - 1));
    return this.table[Math.min(steps - 1, Math.max(0, step))];
  }

  /** sRGB of each distance, three bytes after three. */
  paint(distances: readonly number[]): Uint8Array<ArrayBuffer> {
    const bytes = new Uint8Array(3 * distances.length);
    distances.forEach((distance, i) => bytes.set(this.color(distance), 3 * i));
    return bytes;
  }
}

/** "#440154" in numbers. */
function bytesOf(color: string): [number, number, number] {
  const value = Number.parseInt(color.slice(1), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
}
