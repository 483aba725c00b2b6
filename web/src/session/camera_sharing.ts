import type { Api } from "../connection/api";
import type { Camera } from "../gen/phrenic/v1/control_pb";
import type { Pose } from "../geometry/camera_pose";
import type { Clock } from "../timing/clock";
import { NewestWins } from "../timing/coalescing_sender";
import type { Standing } from "./participation";

/** A picture whose camera may be read and placed. */
export interface Staged {
  readonly pose: Pose;
  place(pose: Pose): void;
}

/** Shows the others where who controls looks from, ten times a second at most, and follows where this viewer wants to. */
export class CameraLead {
  private readonly shown: NewestWins<{ camera: Pose }>;
  private last = "";
  private theirs: Camera | undefined;

  constructor(
    api: Api,
    sessionId: string,
    private readonly standing: Standing,
    private readonly stage: Staged,
    clock: Clock,
  ) {
    const send = async ({ camera }: { camera?: Pose }) => {
      // What is refused here is shown by the controls: somebody else has control now.
      if (camera !== undefined) await api.control.showCamera({ sessionId, camera }).catch(() => undefined);
    };
    this.shown = new NewestWins<{ camera: Pose }>(send, clock, () => undefined);
    standing.roles.subscribe(({ alone }) => {
      if (alone) this.drawn();
      else this.last = "";
    });
  }

  /** The picture was drawn: its camera may have moved. */
  drawn(): void {
    if (!this.standing.roles.value.alone) return;
    const camera = this.stage.pose;
    const words = JSON.stringify(camera);
    if (words === this.last) return;
    this.last = words;
    this.shown.push({ camera });
  }

  /** Who controls looks from there. */
  receive(camera: Camera): void {
    this.theirs = camera;
    this.follow();
  }

  /** Goes where they look from, where this viewer follows. */
  follow(): void {
    const { eye, target } = this.theirs ?? {};
    if (!this.standing.identity.follows || this.standing.roles.value.alone) return;
    if (eye !== undefined && target !== undefined) this.stage.place({ eye, target });
  }
}
