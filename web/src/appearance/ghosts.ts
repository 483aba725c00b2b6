import { EndExpirationDetector } from "../frames/end_expiration";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import type { Signal } from "../state/signal";
import type { Viewer } from "../viewer/viewer";

/** What else is shown, as it was at another moment. */
export type GhostKind = "none" | "rest" | "expiration" | "now";

/** The ghost of one picture, of the kind that somebody chose. */
export class GhostSelector {
  private readonly endExpiration = new EndExpirationDetector();
  private deformable: Body[] = [];

  constructor(
    private readonly viewer: Viewer,
    private readonly arrays: () => FrameArrays | undefined,
    private readonly kind: Signal<GhostKind>,
  ) {
    kind.subscribe(() => this.show());
  }

  /** Another scene: its deformable bodies. What was is of another matter. */
  start(moving: Body[]): void {
    this.deformable = moving;
    this.show(this.kind.value === "rest");
  }

  receive({ breath }: Frame): void {
    const turned = this.endExpiration.receive(breath);
    if (turned && this.kind.value === "expiration") this.viewer.setGhost(this.arrays(), this.deformable);
  }

  private show(known = true): void {
    const kind = known ? this.kind.value : "none";
    this.viewer.setGhost(kind === "now" ? this.arrays() : kind === "rest" ? "rest" : undefined, this.deformable);
  }
}
