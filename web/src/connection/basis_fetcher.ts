import type { GetBasisResponse } from "../gen/phrenic/v1/frames_pb";

/** Fetches the basis of CODEC_BASIS whenever the server has a newer one. */
export class BasisFetcher {
  private knownEpoch = 0n;
  private fetching = false;

  constructor(
    private readonly request: () => Promise<GetBasisResponse>,
    private readonly onBasis: (basis: GetBasisResponse) => void,
  ) {}

  /** Epoch of the received basis; 0 without one. */
  get epoch(): bigint {
    return this.knownEpoch;
  }

  /** Fetches the basis if this epoch is newer than the known one. */
  offered(epoch: bigint): void {
    if (epoch > this.knownEpoch && !this.fetching) void this.fetch();
  }

  private async fetch(): Promise<void> {
    this.fetching = true;
    try {
      const basis = await this.request();
      this.onBasis(basis);
      this.knownEpoch = basis.epoch;
    } catch {
      // The next acknowledgement offers it again.
    }
    this.fetching = false;
  }
}
