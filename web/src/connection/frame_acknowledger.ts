import type { AckFramesResponse } from "../gen/phrenic/v1/frames_pb";
import type { Clock } from "../timing/clock";

/** Delay after a failed acknowledgement [ms]; without acknowledgements the server sends no more frames. */
const retryDelay = 500;

/**
 * Acknowledges received frames to the server: only the newest one, one call at a time. The server sends no more than a
 * few unacknowledged frames, so that frames do not queue up on a slow machine or line. One call for half of this number
 * keeps the stream going.
 */
export class FrameAcknowledger {
  private newestSequence = 0n;
  private unacknowledged = 0; // since the last call
  private batchSize = 1; // frames per call
  private running = false;

  constructor(
    private readonly send: (sequence: bigint) => Promise<AckFramesResponse>,
    private readonly clock: Clock,
    private readonly signal: AbortSignal,
    private readonly onAnswer: (response: AckFramesResponse, sent: number, at: number) => void,
  ) {}

  /** Records a received frame and acknowledges it when enough frames have arrived. */
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
      await this.clock.sleep(retryDelay, this.signal); // the connection detects a lost server
    }
  }
}
