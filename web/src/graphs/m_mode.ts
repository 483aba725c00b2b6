import type { TimeSpan } from "./window";

/** Depth of the dome at rest below the probe, and of the end of the picture [m]. */
export const restDepth = 0.1;
export const pictureDepth = 0.14;
/** Longest time between two samples that are joined: a fifth of a quiet breath [simulated s]. */
const longestGap = 0.8;
/** Half the thickness of an echo [m]. */
const echo = 0.0012;
/** Distance over which the mirror image beyond the diaphragm fades [m]. */
const fading = 0.015;
/** Size of the grain of tissue [m]. */
const grain = 0.0016;

interface Sample {
  time: number;
  /** Where the column crosses the diaphragm: depths below the probe [m], ascending. */
  depths: number[];
}

/** The echoes of one column over the last `span` seconds of simulated time. */
export class ColumnRecord {
  private readonly samples: Sample[] = [];

  /** `summit` is the height of the dome at rest [m]. */
  constructor(
    private readonly summit: number,
    private readonly span: number,
  ) {}

  /** Adds the heights at which the column crosses the diaphragm [m], ascending. Starts again if time goes back. */
  add(time: number, heights: number[]): void {
    const last = this.samples.at(-1);
    if (last !== undefined && time === last.time) return;
    if (last !== undefined && time < last.time) this.samples.length = 0;
    this.samples.push({ time, depths: heights.map((height) => restDepth + height - this.summit) });
    while (this.samples[0].time < time - this.span) this.samples.shift();
  }

  /** Returns the depths of the echoes at a time [m], interpolated; undefined where nothing was recorded. */
  depthsAt(time: number): number[] | undefined {
    const { samples } = this;
    let [low, high] = [0, samples.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (samples[middle].time < time) low = middle + 1;
      else high = middle;
    }
    const [before, after] = [samples[low - 1], samples[low]] as (Sample | undefined)[];
    if (after !== undefined && after.time === time) return after.depths;
    if (before === undefined || after === undefined || after.time - before.time > longestGap) return undefined;
    const part = (time - before.time) / (after.time - before.time);
    const near = part < 0.5 ? before : after;
    if (before.depths.length !== after.depths.length) return near.depths;
    return before.depths.map((depth, i) => depth + part * (after.depths[i] - depth));
  }

  /** The depth of the nearest echo in the newest sample [m]; undefined without one. */
  get newest(): number | undefined {
    return this.samples.at(-1)?.depths[0];
  }
}

/**
 * Returns the brightness at a depth [m], 0 to 1, as an ultrasound probe below the ribs sees it: grainy liver or spleen,
 * each surface of the diaphragm as a bright line, and beyond it the fading mirror image that air gives. The grain moves
 * with the dome; only the lines are computed from the model.
 */
export function brightness(depth: number, echoes: number[]): number {
  let line = 0;
  for (const each of echoes) line = Math.max(line, Math.exp(-(((depth - each) / echo) ** 2)));
  const [first, last] = [echoes[0] ?? Infinity, echoes[echoes.length - 1] ?? Infinity];
  const within = depth > first && depth < last;
  const beyond = depth >= last;
  const tissue = beyond ? Math.exp((last - depth) / fading) * 0.5 : within ? 0.35 : 1;
  const texture = 0.14 + 0.2 * noise(Math.floor(((beyond ? 2 * last - depth : depth) - first) / grain));
  return Math.min(1, line + tissue * texture);
}

/** Returns the same number from 0 to 1 for the same integer. */
function noise(index: number): number {
  const mixed = Math.imul(index ^ 0x9e3779b9, 0x85ebca6b);
  return ((mixed ^ (mixed >>> 13)) >>> 0) / 0xffffffff;
}

/** Fills a picture with a record over a time span, one grey level per pixel as RGBA; black where nothing is known. */
export function paint(pixels: Uint8ClampedArray, width: number, record: ColumnRecord, span: TimeSpan): void {
  const height = pixels.length / 4 / width;
  for (let column = 0; column < width; column++) {
    const time = span.start + ((column + 0.5) / width) * (span.end - span.start);
    const echoes = record.depthsAt(time);
    for (let row = 0; row < height; row++) {
      const level = echoes === undefined ? 0 : 255 * brightness(((row + 0.5) / height) * pictureDepth, echoes);
      const at = 4 * (row * width + column);
      pixels[at] = pixels[at + 1] = pixels[at + 2] = level;
      pixels[at + 3] = 255;
    }
  }
}
