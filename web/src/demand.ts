/** A delay that means frames pile up somewhere on the way, and one that means there is room [ms]. */
const late = 500;
const prompt = 100;
/** How long each must last before the demand changes [ms]. */
const patienceLate = 1500;
const patiencePrompt = 10_000;
const fewest = 2;
const most = 30;

/**
 * How many frames a second a viewer asks for. What a slow machine or line cannot take in time would wait in buffers and
 * be shown late; so it asks for fewer until frames come promptly, and for more again when they have for a while.
 */
export class Demand {
  /** Frames a second; 0 is the server's own rate. */
  framesPerSecond = 0;
  private lateSince: number | undefined;
  private promptSince: number | undefined;

  /** Judges the delay [ms] of the newest frames and the rate at which they arrive; true where the demand changes. */
  judge(now: number, delay: number, arriving: number): boolean {
    this.lateSince = delay > late ? (this.lateSince ?? now) : undefined;
    this.promptSince = delay < prompt ? (this.promptSince ?? now) : undefined;
    if (this.lateSince !== undefined && now - this.lateSince >= patienceLate) return this.change(0.7 * arriving, now);
    const grows = this.framesPerSecond > 0 && this.promptSince !== undefined;
    if (grows && now - this.promptSince! >= patiencePrompt) return this.change(1.5 * this.framesPerSecond, now);
    return false;
  }

  private change(wanted: number, now: number): boolean {
    this.lateSince = undefined;
    this.promptSince = now;
    const next = wanted > most ? 0 : Math.max(fewest, Math.round(wanted));
    if (next === this.framesPerSecond) return false;
    this.framesPerSecond = next;
    return true;
  }
}
