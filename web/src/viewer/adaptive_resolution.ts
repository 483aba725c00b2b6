/** Beats further apart than this are slow [ms]. */
const slow = 70;
/** Slow beats in a row before the picture gets coarser, and time at rest before it is drawn once in full [ms]. */
const patience = 6;
const rest = 400;
const coarsest = 0.5;

/**
 * Pixels drawn for each CSS pixel. A machine that cannot keep up gets fewer of them while things move, so that the page
 * stays alive, and the full number as soon as the picture stands still.
 */
export class Sharpness {
  private moving: number;
  private current: number;
  private slowBeats = 0;
  private lastDrawn = -Infinity;
  private lastBeat = -Infinity;

  constructor(private readonly full: number) {
    this.moving = full;
    this.current = full;
  }

  get ratio(): number {
    return this.current;
  }

  /** Takes note of a beat at `now` [ms] and whether it draws; true where `ratio` changes with it. */
  beat(now: number, draws: boolean): boolean {
    const steady = draws && this.lastDrawn === this.lastBeat;
    if (steady) this.judge(now - this.lastBeat);
    this.lastBeat = now;
    if (draws) this.lastDrawn = now;
    const wanted = !draws && now - this.lastDrawn > rest ? this.full : draws ? this.moving : this.current;
    const changed = wanted !== this.current;
    this.current = wanted;
    return changed;
  }

  private judge(interval: number): void {
    this.slowBeats = interval > slow ? this.slowBeats + 1 : 0;
    if (this.slowBeats < patience) return;
    this.slowBeats = 0;
    this.moving = Math.max(Math.min(coarsest, this.full), this.moving * 0.7);
  }
}
