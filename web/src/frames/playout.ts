/** Two successive frames and the interpolation parameter between them, 0 to 1. */
export interface FramePair<T> {
  before: T;
  after: T;
  part: number;
}

/** Longest delay of a frame, and longest gap that is interpolated [ms]. */
export const maxHold = 150;
/** Window over which arrivals are observed [ms]. */
const windowLength = 1000;
/** Rates at which the delay may shrink and grow [ms/ms]; playback then runs at 0.5 to 1.1 times real speed. */
const [shrinking, growing] = [0.1, 0.5];

interface BufferedItem<T> {
  item: T;
  /** Creation time by the server's clock [ms]. */
  made: number;
}

/**
 * A playout (jitter) buffer: frames arrive irregularly, the display moves evenly. It displays the time `hold` ago by
 * the server's clock, which is about one frame interval plus the variation of the delays, so that the next frame has
 * usually arrived. It only interpolates between received frames and never goes back.
 */
export class PlayoutBuffer<T> {
  private frames: BufferedItem<T>[] = [];
  /** Required delay of each frame in the window [ms]; includes the offset between the clocks. */
  private needs: { arrived: number; need: number }[] = [];
  private newestLag = 0;
  private hold: number | undefined;
  private shown = -Infinity;
  private asked = -Infinity;

  /** Adds a frame with its creation time by the server's clock and its arrival time by the local clock [ms]. */
  receive(item: T, made: number, arrived: number): void {
    const gap = made - (this.frames.at(-1)?.made ?? -Infinity);
    if (gap <= 0 || gap > maxHold) this.clear();
    this.frames.push({ item, made });
    // A hidden page requests no frames; older ones than any delay are never displayed.
    while (this.frames[1]?.made < made - 2 * maxHold) this.frames.shift();
    this.newestLag = arrived - made;
    if (this.frames.length === 1) return;
    this.needs.push({ arrived, need: this.newestLag + gap });
    this.needs = this.needs.filter((each) => each.arrived > arrived - windowLength);
  }

  /** Returns what to display at `now` [ms]; undefined before the first frame. */
  at(now: number): FramePair<T> | undefined {
    const newest = this.frames.at(-1);
    if (newest === undefined) return undefined;
    this.slew(now);
    const due = this.hold === undefined ? newest.made : Math.min(now - this.hold, newest.made);
    this.shown = Math.max(this.shown, due, this.frames[0].made);
    while (this.frames.length > 1 && this.frames[1].made <= this.shown) this.frames.shift();
    const [before, after] = [this.frames[0], this.frames[1] ?? this.frames[0]];
    const gap = after.made - before.made;
    return { before: before.item, after: after.item, part: gap > 0 ? (this.shown - before.made) / gap : 0 };
  }

  /** Delay between arrival and display of the newest frame [ms]. */
  get delay(): number {
    return this.hold === undefined ? 0 : Math.max(0, this.hold - this.newestLag);
  }

  /** Clears everything; the next frame is displayed immediately. */
  clear(): void {
    this.frames = [];
    this.needs = [];
    this.hold = undefined;
    this.shown = -Infinity;
  }

  private slew(now: number): void {
    const passed = Math.max(0, now - this.asked);
    this.asked = now;
    if (this.needs.length === 0) return;
    const wanted = Math.min(Math.max(...this.needs.map(({ need }) => need)), this.newestLag + maxHold);
    const change = wanted - (this.hold ?? wanted);
    this.hold = wanted - change + Math.min(growing * passed, Math.max(-shrinking * passed, change));
  }
}
