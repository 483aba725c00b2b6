import { scaleLinear } from "d3-scale";
import { interpolatePuOr, interpolateViridis } from "d3-scale-chromatic";

/** A tick beside the scale: its position along it, 0 to 1, and its label. */
export interface Tick {
  fraction: number;
  text: string;
}

/** Smallest end of a distance scale [mm]: smaller distances are rounding errors. */
const smallestTop = 0.001;
const tableSize = 256;
/** First part of the colour map that is left out, since its colours are hardly visible on a dark background. */
const mapStart = 0.12;
/** Colour of a vertex without a value. */
const missingColor: [number, number, number] = [128, 136, 146];

/** Returns the largest of the values, but at least `least`, rounded up to a round number. */
export function niceTop(values: ArrayLike<number>, least = smallestTop): number {
  let largest = least;
  for (let i = 0; i < values.length; i++) if (values[i] > largest) largest = values[i];
  return scaleLinear([0, largest], [0, 1]).nice(5).domain()[1];
}

/**
 * A perceptually uniform colour scale from 0 to `top`, or a diverging one from -`top` to `top` with a light centre;
 * both are suitable for colour-blind people.
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

  /** Returns about five ticks. */
  ticks(): Tick[] {
    const scale = scaleLinear([this.low, this.top], [0, 1]);
    const words = scale.tickFormat(5);
    return scale.ticks(5).map((value) => ({ fraction: scale(value), text: words(value) }));
  }

  /** Returns the sRGB bytes of a value; values outside of the scale get its end colours, NaN a grey. */
  color(value: number): [number, number, number] {
    if (Number.isNaN(value)) return missingColor;
    const step = Math.round(((value - this.low) / (this.top - this.low)) * (tableSize - 1));
    return this.table[Math.min(tableSize - 1, Math.max(0, step))];
  }

  /** Returns three sRGB bytes for each value. */
  colors(values: ArrayLike<number>): Uint8Array<ArrayBuffer> {
    const bytes = new Uint8Array(3 * values.length);
    for (let i = 0; i < values.length; i++) bytes.set(this.color(values[i]), 3 * i);
    return bytes;
  }
}

/** Parses "#440154" or "rgb(68, 1, 84)". */
function parseColor(color: string): [number, number, number] {
  const triple = color.startsWith("#")
    ? [1, 3, 5].map((at) => Number.parseInt(color.slice(at, at + 2), 16))
    : color.match(/\d+/g)!.map(Number);
  return [triple[0], triple[1], triple[2]];
}
