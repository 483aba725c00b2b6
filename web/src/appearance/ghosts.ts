import { EndExpirationDetector } from "../frames/end_expiration";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import type { Signal } from "../state/signal";
import type { Viewer } from "../viewer/viewer";

/** The state that is drawn as a translucent ghost beside the current one; "beside": that of the second view. */
export type GhostKind = "none" | "rest" | "expiration" | "now" | "beside";

/** Shows the ghost of one view, of the selected kind. */
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

  /** Starts another scene with these deformable bodies; keeps only a ghost at rest. */
  start(moving: Body[]): void {
    this.deformable = moving;
    this.show(this.kind.value === "rest");
  }

  /** Receives every frame, to detect the end of expiration. */
  receive({ breath }: Frame): void {
    const turned = this.endExpiration.receive(breath);
    if (turned && this.kind.value === "expiration") this.viewer.setGhost(this.arrays(), this.deformable);
  }

  /** Shows the outline of the same bodies in the second view, if that is selected. */
  showBeside(arrays: FrameArrays | undefined): void {
    if (this.kind.value === "beside") this.viewer.setGhost(arrays, this.deformable, true);
  }

  private show(known = true): void {
    const kind = known ? this.kind.value : "none";
    this.viewer.setGhost(kind === "now" ? this.arrays() : kind === "rest" ? "rest" : undefined, this.deformable);
  }
}
