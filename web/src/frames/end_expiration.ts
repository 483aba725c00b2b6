/** Detects the end of expiration: the minimum of the breath signal. */
export class EndExpirationDetector {
  private falling = false;
  private last: number | undefined;

  /** Returns true if the signal has just started to rise. */
  receive(breath: number): boolean {
    const last = this.last;
    this.last = breath;
    if (last === undefined || breath === last) return false;
    const turned = this.falling && breath > last;
    this.falling = breath < last;
    return turned;
  }
}
