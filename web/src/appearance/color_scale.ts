import { scaleLinear } from "d3-scale";
import { interpolatePuOr, interpolateViridis } from "d3-scale-chromatic";

/** A mark beside the scale: how far along it, 0 to 1, and its words. */
export interface Tick {
  fraction: number;
  text: string;
}

/** The least length that a scale ends at [mm]: below it surfaces are the same. */
const smallestTop = 0.001;
const tableSize = 256;
/** Where the colour map is entered: its first colours are lost on a dark ground. */
const mapStart = 0.12;
/** The colour of a vertex that has no value. */
const missingColor: [number, number, number] = [128, 136, 146];

/** The end of a scale that shows all of these values: their largest, rounded up; `least` where they are smaller. */
export function niceTop(values: ArrayLike<number>, least = smallestTop): number {
  let largest = least;
  for (let i = 0; i < values.length; i++) if (values[i] > largest) largest = values[i];
  return scaleLinear([0, largest], [0, 1]).nice(5).domain()[1];
}

/**
 * Colours for values from 0 to `top`, or of a diverging scale from -`top` to `top` with the middle light: equal
 * differences look equally large, also to the colour-blind.
 */
export class ColorScale {
  readonly low: number;
  private readonly table: [number, number, number][];

  constructor(
    readonly top: number,
    readonly unit = "mm",
    diverging = false,
  ) {
    this.low = diverging ? -top : 0;
    const map = diverging
      ? (part: number) => interpolatePuOr(1 - part)
      : (part: number) => interpolateViridis(mapStart + (1 - mapStart) * part);
    this.table = Array.from({ length: tableSize }, (_, i) => parseColor(map(i / (tableSize - 1))));
  }

  /** About five. */
  ticks(): Tick[] {
    const scale = scaleLinear([this.low, this.top], [0, 1]);
    const words = scale.tickFormat(5);
    return scale.ticks(5).map((value) => ({ fraction: scale(value), text: words(value) }));
  }

  /** sRGB of a value; what is beyond the scale has its last colour. */
  color(value: number): [number, number, number] {
    if (Number.isNaN(value)) return missingColor;
    const step = Math.round(((value - this.low) / (this.top - this.low)) * (tableSize - 1));
    return this.table[Math.min(tableSize - 1, Math.max(0, step))];
  }

  /** sRGB of each value, three bytes after three. */
  colors(values: ArrayLike<number>): Uint8Array<ArrayBuffer> {
    const bytes = new Uint8Array(3 * values.length);
    for (let i = 0; i < values.length; i++) bytes.set(this.color(values[i]), 3 * i);
    return bytes;
  }
}

/** "#440154" or "rgb(68, 1, 84)" in numbers. */
function parseColor(color: string): [number, number, number] {
  const triple = color.startsWith("#")
    ? [1, 3, 5].map((at) => Number.parseInt(color.slice(at, at + 2), 16))
    : color.match(/\d+/g)!.map(Number);
  return [triple[0], triple[1], triple[2]];
}
