import { fixed, t } from "../language/translate";
/** The height of each dome above rest [m], and the breath's signal (0 at rest, 1 at its peak), at one time [s]. */
export interface DomeHeights {
  time: number;
  breath: number;
  right: number;
  left: number;
}

/**
 * What sniffs move: the change of each dome's height [m], negative downwards, and their heights before the last one.
 */
export interface SniffResult {
  /** Time of the last sniff [s]. */
  onset: number;
  /** The largest changes of all sniffs: frames of a slow machine miss peaks. */
  right: number;
  left: number;
  before: DomeHeights;
  sniffs: number;
  /** Largest time between two frames of a sniff, in the one with the most frames [s]. */
  gap: number;
}

/** Simulated time before the first sniff that counts [s]: the breath before it must have ended. */
const settling = 1;
/** The breath's signal below which nothing contracts. */
const quiet = 0.02;
/** Longest time that is measured from the onset [s]. */
const longest = 2;
/** Time that is plotted [s], and sniffs that are measured. */
const kept = 10;
const mostSniffs = 3;

/**
 * Waits for sniffs and measures how far they move each dome: by the largest change of height while the breath lasts.
 */
export class SniffTest {
  readonly heights: DomeHeights[] = [];
  result: SniffResult | undefined;
  private start: number | undefined;
  private before: DomeHeights | undefined;

  /**
   * Receives every frame, in the order of time. Starts again if time goes back. Returns true when the result changes.
   */
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
    if (now.time - this.start < settling || this.result?.sniffs === mostSniffs) return false;
    if (this.before === undefined) {
      if (last !== undefined && last.breath <= quiet && now.breath > quiet) this.before = last;
      return false;
    }
    const since = now.time - this.before.time;
    if (since < longest && (now.breath > quiet || since < 0.1)) return false;
    this.result = joined(this.result, this.measure(this.before));
    this.before = undefined;
    return true;
  }

  private measure(before: DomeHeights): SniffResult {
    const sniff = this.heights.filter(({ time }) => time >= before.time);
    const moves = (side: "right" | "left") => sniff.map((each) => each[side] - before[side]);
    const gaps = sniff.slice(1).map(({ time }, i) => time - sniff[i].time);
    const [right, left] = [largestOf(moves("right")), largestOf(moves("left"))];
    return { onset: before.time, right, left, before, sniffs: 1, gap: Math.max(0, ...gaps) };
  }
}

/** Returns the number with the largest magnitude. */
function largestOf(all: number[]): number {
  return all.reduce((most, each) => (Math.abs(each) > Math.abs(most) ? each : most), 0);
}

function joined(known: SniffResult | undefined, next: SniffResult): SniffResult {
  if (known === undefined) return next;
  const [right, left] = [largestOf([known.right, next.right]), largestOf([known.left, next.left])];
  return { ...next, right, left, sniffs: known.sniffs + 1, gap: Math.min(known.gap, next.gap) };
}

/** Frames further apart than this may miss some of a peak [s]. */
const sparse = 0.06;

/** A dome that rises by more than this moves paradoxically [mm]. */
const paradoxical = 2;
/** Lower limit of the excursion in a sniff in healthy women [mm] (men 18): Boussuges et al., Chest 2009;135:391. */
const lowest = 16;

/** Returns the millimetres of a dome in words: "right dome 31 mm down". */
export function domeWords(side: string, change: number): string {
  const mm = Math.round(1000 * Math.abs(change));
  const words = mm === 0 ? "{0} does not move" : change < 0 ? "{0} {1} mm down" : "{0} {1} mm up";
  return t(words, t(`${side} dome`), mm);
}

/** Returns the result in words: both excursions, and what they mean by published limits. */
export function sniffWords({ right, left, sniffs, gap }: Omit<SniffResult, "onset" | "before">): string {
  const sides = [["right", 1000 * right], ["left", 1000 * left]] as const; // prettier-ignore
  const numbers = sides.map(([side, mm]) => domeWords(side, mm / 1000)).join(", ");
  const of = sniffs > 1 ? t(" (the most of {0} sniffs)", sniffs) : "";
  const missed = gap > sparse ? t(" Frames are {0} s apart here, so that peaks may be larger.", fixed(gap, 2)) : "";
  return `${numbers.charAt(0).toUpperCase()}${numbers.slice(1)}${of}. ${meaning(sides)}${missed}`;
}

function meaning(sides: readonly (readonly [side: string, mm: number])[]): string {
  const rising = sides.filter(([, mm]) => mm > paradoxical);
  if (rising.length === 2) return t("Both domes rise: paradoxical on both sides.") + remark(rising);
  if (rising.length === 1) {
    const [[side]] = rising;
    const other = sides.find(([name]) => name !== side)!;
    const falls = other[1] < -paradoxical;
    const words = falls
      ? "The {0} rises while the {1} falls: paradoxical, as when its phrenic nerve is cut."
      : "The {0} rises and the {1} hardly moves: paradoxical, as when its phrenic nerve is cut.";
    return t(words, t(`${side} dome`), t(`${other[0]} dome`)) + remark(rising);
  }
  const weak = sides.filter(([, mm]) => mm > -lowest).map(([side]) => side);
  if (weak.length === 0) return t("Both domes fall, as in health (29 ± 6 mm in men, 26 ± 5 mm in women).");
  const both = "Both domes fall by less than {0} mm, the lower limit of healthy women: reduced, not paradoxical.";
  const one = "The {1} falls by less than {0} mm, the lower limit of healthy women: reduced, not paradoxical.";
  return t(weak.length === 2 ? both : one, lowest, t(`${weak[0]} dome`));
}

/** Alexander, Clin Radiol 1966;17:79. */
function remark(rising: readonly (readonly [string, number])[]): string {
  return rising.every(([, mm]) => mm < 20) ? t(" Below 20 mm it is also seen in healthy people (Alexander 1966).") : "";
}
