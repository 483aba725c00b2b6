import type { AckFramesResponse } from "../gen/phrenic/v1/frames_pb";
import type { Clock } from "../timing/clock";

/** How long to wait after an acknowledgement that failed [ms]: without one no more frames come. */
const retryDelay = 500;

/**
 * Tells the server which frames have come, the newest alone and one call at a time: what a slow machine or line leaves
 * waiting is not sent on top, so that what is shown is never old. One call for half of the frames that may be on their
 * way is enough to keep them coming.
 */
export class FrameAcknowledger {
  private newestSequence = 0n;
  private unacknowledged = 0; // since the last call
  private batchSize = 1; // for a call
  private running = false;

  constructor(
    private readonly send: (sequence: bigint) => Promise<AckFramesResponse>,
    private readonly clock: Clock,
    private readonly signal: AbortSignal,
    private readonly onAnswer: (response: AckFramesResponse, sent: number, at: number) => void,
  ) {}

  received(sequence: bigint): void {
    this.newestSequence = sequence;
    this.unacknowledged++;
    if (!this.running) void this.run();
  }

  private async run(): Promise<void> {
    this.running = true;
    while (this.unacknowledged >= this.batchSize && !this.signal.aborted) await this.acknowledge(this.newestSequence);
    this.running = false;
  }

  private async acknowledge(sequence: bigint): Promise<void> {
    const sent = this.clock.now();
    const taken = this.unacknowledged;
    try {
      const response = await this.send(sequence);
      this.unacknowledged -= taken;
      this.batchSize = Math.max(1, Math.floor(response.maxUnackedFrames / 2));
      this.onAnswer(response, sent, this.clock.now());
    } catch {
      await this.clock.sleep(retryDelay, this.signal); // a line that is lost is noticed by who watches
    }
  }
}
