/** Two frames between which the picture stands, and how far along, 0 to 1. */
export interface FramePair<T> {
  before: T;
  after: T;
  part: number;
}

/** The longest that a frame is held back, and the longest gap that is bridged [ms]. */
export const maxHold = 150;
/** How long an arrival counts [ms]. */
const windowLength = 1000;
/** How fast the hold may shrink and grow [ms a ms]: the picture goes at 0.5 to 1.1 times the true pace meanwhile. */
const [shrinking, growing] = [0.1, 0.5];

interface BufferedItem<T> {
  item: T;
  /** By the server's clock [ms]. */
  made: number;
}

/**
 * Frames come when they come; the picture moves evenly. It shows the moment `hold` ago, by the server's clock: so long
 * that the next frame is there before the picture gets to the last, about one frame and what their delays vary by. It
 * only ever stands between frames that have come, and never goes back.
 */
export class PlayoutBuffer<T> {
  private frames: BufferedItem<T>[] = [];
  /** Of the last second: what the hold should have been for each frame [ms]; both clocks' difference is part of it. */
  private needs: { arrived: number; need: number }[] = [];
  private newestLag = 0;
  private hold: number | undefined;
  private shown = -Infinity;
  private asked = -Infinity;

  /** `made` by the server's clock and `arrived` by one's own [ms]. */
  receive(item: T, made: number, arrived: number): void {
    const gap = made - (this.frames.at(-1)?.made ?? -Infinity);
    if (gap <= 0 || gap > maxHold) this.clear();
    this.frames.push({ item, made });
    // A page that nobody looks at asks for nothing; what is older than any hold is never shown.
    while (this.frames[1]?.made < made - 2 * maxHold) this.frames.shift();
    this.newestLag = arrived - made;
    if (this.frames.length === 1) return;
    this.needs.push({ arrived, need: this.newestLag + gap });
    this.needs = this.needs.filter((each) => each.arrived > arrived - windowLength);
  }

  /** What to show at `now` [ms]; nothing before the first frame. */
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

  /** How much later than it came the newest frame is shown [ms]. */
  get delay(): number {
    return this.hold === undefined ? 0 : Math.max(0, this.hold - this.newestLag);
  }

  /** Forgets everything: what comes next is shown at once. */
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
