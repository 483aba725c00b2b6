/** The height of each dome above rest [m], and the breath's signal (0 at rest, 1 at its peak), at one time [s]. */
export interface DomeHeights {
  time: number;
  breath: number;
  right: number;
  left: number;
}

/** What a sniff moves: the change of each dome's height [m], negative downwards, and their heights before it. */
export interface SniffResult {
  onset: number;
  right: number;
  left: number;
  before: DomeHeights;
}

/** Simulated time before the first sniff that counts [s]: the breath before it must have ended. */
const settling = 1;
/** The breath's signal below which nothing contracts. */
const quiet = 0.02;
/** Longest time that is measured from the onset [s]. */
const longest = 2;
/** Time that is plotted [s]. */
const kept = 10;

/** Waits for a sniff and measures how far it moves each dome: by the largest change of height while the breath lasts. */
export class SniffTest {
  readonly heights: DomeHeights[] = [];
  result: SniffResult | undefined;
  private start: number | undefined;
  private before: DomeHeights | undefined;

  /** Receives every frame, in the order of time. Starts again if time goes back. Returns true once, when the result is known. */
  receive(now: DomeHeights): boolean {
    const last = this.heights.at(-1);
    if (last !== undefined && now.time <= last.time) {
      if (now.time === last.time) return false;
      this.heights.length = 0;
      this.start = this.before = this.result = undefined;
    }
    this.heights.push(now);
    while (this.heights[0].time < now.time - kept) this.heights.shift();
    this.start ??= now.time;
    if (this.result !== undefined || now.time - this.start < settling) return false;
    if (this.before === undefined) {
      if (last !== undefined && last.breath <= quiet && now.breath > quiet) this.before = last;
      return false;
    }
    const since = now.time - this.before.time;
    if (since < longest && (now.breath > quiet || since < 0.1)) return false;
    this.result = this.measure(this.before);
    return true;
  }

  private measure(before: DomeHeights): SniffResult {
    const sniff = this.heights.filter(({ time }) => time >= before.time);
    const largest = (side: "right" | "left") =>
      sniff.reduce((most, each) => (Math.abs(each[side] - before[side]) > Math.abs(most) ? each[side] - before[side] : most), 0); // prettier-ignore
    return { onset: before.time, right: largest("right"), left: largest("left"), before };
  }
}

/** A dome that rises by more than this moves paradoxically [mm]. */
const paradoxical = 2;
/** Lower limit of the excursion in a sniff in healthy women [mm] (men 18): Boussuges et al., Chest 2009;135:391. */
const lowest = 16;

/** Returns the millimetres of a dome in words: "right dome 31 mm down". */
export function domeWords(side: string, change: number): string {
  const mm = Math.round(1000 * Math.abs(change));
  return `${side} dome ${mm === 0 ? "does not move" : `${mm} mm ${change < 0 ? "down" : "up"}`}`;
}

/** Returns the result in words: both excursions, and what they mean by published limits. */
export function sniffWords({ right, left }: Pick<SniffResult, "right" | "left">): string {
  const sides = [["right", 1000 * right], ["left", 1000 * left]] as const; // prettier-ignore
  const numbers = sides.map(([side, mm]) => domeWords(side, mm / 1000)).join(", ");
  return `${numbers.charAt(0).toUpperCase()}${numbers.slice(1)}. ${meaning(sides)}`;
}

function meaning(sides: readonly (readonly [side: string, mm: number])[]): string {
  const rising = sides.filter(([, mm]) => mm > paradoxical);
  if (rising.length === 2) return `Both domes rise: paradoxical on both sides.${remark(rising)}`;
  if (rising.length === 1) {
    const [[side]] = rising;
    const other = sides.find(([name]) => name !== side)!;
    const beside = other[1] < -paradoxical ? `while the ${other[0]} one falls` : `and the ${other[0]} one hardly moves`;
    return `The ${side} dome rises ${beside}: paradoxical, as when its phrenic nerve is cut.${remark(rising)}`;
  }
  const weak = sides.filter(([, mm]) => mm > -lowest).map(([side]) => side);
  if (weak.length === 0) return "Both domes fall, as in health (29 ± 6 mm in men, 26 ± 5 mm in women).";
  const which = weak.length === 2 ? "Both domes fall" : `The ${weak[0]} dome falls`;
  return `${which} by less than ${lowest} mm, the lower limit of healthy women: reduced, not paradoxical.`;
}

/** Alexander, Clin Radiol 1966;17:79. */
function remark(rising: readonly (readonly [string, number])[]): string {
  return rising.every(([, mm]) => mm < 20) ? " Below 20 mm it is also seen in healthy people (Alexander 1966)." : "";
}
