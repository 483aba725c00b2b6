import type { Api } from "../connection/api";
import type { Camera } from "../gen/phrenic/v1/control_pb";
import type { CameraPose } from "../geometry/camera_pose";
import type { Clock } from "../timing/clock";
import { CoalescingSender } from "../timing/coalescing_sender";
import type { Participation } from "./participation";

/** A picture whose camera may be read and placed. */
export interface SharedCamera {
  readonly pose: CameraPose;
  moveTo(pose: CameraPose): void;
}

/** Shows the others where who controls looks from, ten times a second at most, and follows where this viewer wants to. */
export class CameraSharing {
  private readonly sender: CoalescingSender<{ camera: CameraPose }>;
  private lastSent = "";
  private remoteCamera: Camera | undefined;

  constructor(
    api: Api,
    sessionId: string,
    private readonly participation: Participation,
    private readonly camera: SharedCamera,
    clock: Clock,
  ) {
    const send = async ({ camera }: { camera?: CameraPose }) => {
      // What is refused here is shown by the controls: somebody else has control now.
      if (camera !== undefined) await api.control.showCamera({ sessionId, camera }).catch(() => undefined);
    };
    this.sender = new CoalescingSender<{ camera: CameraPose }>(send, clock, () => undefined);
    participation.roles.subscribe(({ hasControl }) => {
      if (hasControl) this.sendIfMoved();
      else this.lastSent = "";
    });
  }

  /** The picture was drawn: its camera may have moved. */
  sendIfMoved(): void {
    if (!this.participation.roles.value.hasControl) return;
    const camera = this.camera.pose;
    const key = JSON.stringify(camera);
    if (key === this.lastSent) return;
    this.lastSent = key;
    this.sender.push({ camera });
  }

  /** Who controls looks from there. */
  receive(camera: Camera): void {
    this.remoteCamera = camera;
    this.follow();
  }

  /** Goes where they look from, where this viewer follows. */
  follow(): void {
    const { eye, target } = this.remoteCamera ?? {};
    if (!this.participation.identity.followsCamera || this.participation.roles.value.hasControl) return;
    if (eye !== undefined && target !== undefined) this.camera.moveTo({ eye, target });
  }
}
