import type { Frame } from "../gen/phrenic/v1/frames_pb";

/** How long frames are kept [simulated s], and how many at most: some megabytes as they came. */
const maxDuration = 20;
const maxFrames = 900;

/** The frames of the last seconds, as they came, and the one that is looked at again. */
export class FrameHistory {
  private frames: Frame[] = [];
  /** The time that is looked back to [s]; nothing in the present. */
  private replayTime: number | undefined;

  add(frame: Frame): void {
    if (frame.time < (this.frames.at(-1)?.time ?? 0)) this.clear();
    this.frames.push(frame);
    while (this.frames.length > maxFrames || this.frames[0].time < frame.time - maxDuration) this.frames.shift();
  }

  clear(): void {
    this.frames = [];
    this.replayTime = undefined;
  }

  /** From the oldest frame to the newest [s]. */
  get span(): { start: number; end: number } {
    return { start: this.frames[0]?.time ?? 0, end: this.frames.at(-1)?.time ?? 0 };
  }

  replayAt(time: number | undefined): void {
    this.replayTime = time;
  }

  /** The last frame up to the time that is looked back to, or the oldest that is left. */
  get replayed(): Frame | undefined {
    return this.frames[this.replayIndex()];
  }

  /** The frame nearest to a time [s]. */
  nearest(time: number): Frame | undefined {
    const away = ({ time: each }: Frame) => Math.abs(each - time);
    const after = this.frames.findIndex((each) => each.time >= time);
    const [a, b] = [this.frames.at(after - 1), this.frames.at(after)];
    return a !== undefined && b !== undefined && after > 0 && away(a) < away(b) ? a : b;
  }

  /** The time of the frame before, or after, the one that is looked at; nothing at the newest. */
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
