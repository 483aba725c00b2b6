import type { Frame } from "../gen/phrenic/v1/frames_pb";

/** Duration that frames are kept [simulated s], and their maximum number: some megabytes of encoded frames. */
const maxDuration = 20;
const maxFrames = 900;

/** The encoded frames of the last seconds, and the one that is replayed. */
export class FrameHistory {
  private frames: Frame[] = [];
  /** The replayed time [s]; undefined when live. */
  private replayTime: number | undefined;

  /** Adds a frame; clears the history first if time goes back. */
  add(frame: Frame): void {
    if (frame.time < (this.frames.at(-1)?.time ?? 0)) this.clear();
    this.frames.push(frame);
    while (this.frames.length > maxFrames || this.frames[0].time < frame.time - maxDuration) this.frames.shift();
  }

  /** Removes all frames and ends the replay. */
  clear(): void {
    this.frames = [];
    this.replayTime = undefined;
  }

  /** Times of the oldest and the newest frame [s]. */
  get span(): { start: number; end: number } {
    return { start: this.frames[0]?.time ?? 0, end: this.frames.at(-1)?.time ?? 0 };
  }

  /** Replays at this time [s]; undefined returns to live frames. */
  replayAt(time: number | undefined): void {
    this.replayTime = time;
  }

  /** The last frame up to the replayed time, or the oldest one; undefined when live. */
  get replayed(): Frame | undefined {
    return this.frames[this.replayIndex()];
  }

  /** Returns the frame nearest to a time [s]. */
  nearest(time: number): Frame | undefined {
    const away = ({ time: each }: Frame) => Math.abs(each - time);
    const after = this.frames.findIndex((each) => each.time >= time);
    const [a, b] = [this.frames.at(after - 1), this.frames.at(after)];
    return a !== undefined && b !== undefined && after > 0 && away(a) < away(b) ? a : b;
  }

  /** Returns the time of the frame before or after the replayed one [s]; undefined for the newest. */
  adjacentTime(by: -1 | 1): number | undefined {
    const from = this.replayTime === undefined ? this.frames.length - 1 : this.replayIndex();
    const to = Math.max(0, from + by);
    return to < this.frames.length - 1 ? this.frames[to]?.time : undefined;
  }

  private replayIndex(): number {
    const { replayTime } = this;
    if (replayTime === undefined) return -1;
    return Math.max(
      0,
      this.frames.findLastIndex(({ time }) => time <= replayTime),
    );
  }
}
