import { Signal } from "../state/signal";

/** Plays a span of time in a loop. */
export class Player {
  /** The displayed time, from 0 to the length [s]. */
  readonly time = new Signal(0);
  readonly playing = new Signal(false);
  /** Simulated seconds per second. */
  speed = 1;
  private before: number | undefined;

  constructor(private readonly length: number) {}

  /** Starts or stops playing; does not start a motion of one frame. */
  setPlaying(playing: boolean): void {
    this.before = undefined;
    this.playing.set(playing && this.length > 0);
  }

  /** Advances to `now` [ms]. Returns true if the displayed time changes. */
  advance(now: number): boolean {
    const passed = this.before === undefined ? 0 : now - this.before;
    this.before = this.playing.value ? now : undefined;
    if (!this.playing.value || passed <= 0) return false;
    this.time.set((this.time.value + (this.speed * passed) / 1000) % this.length);
    return true;
  }

  /** Displays a time [s] and stops. */
  showAt(time: number): void {
    this.setPlaying(false);
    this.time.set(Math.min(this.length, Math.max(0, time)));
  }
}
