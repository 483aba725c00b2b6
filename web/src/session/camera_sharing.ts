import type { Api } from "../connection/api";
import type { Camera } from "../gen/phrenic/v1/control_pb";
import type { CameraPose } from "../geometry/camera_pose";
import type { Clock } from "../timing/clock";
import { CoalescingSender } from "../timing/coalescing_sender";
import type { Participation } from "./participation";

/** A camera whose pose can be read and set. */
export interface SharedCamera {
  readonly pose: CameraPose;
  moveTo(pose: CameraPose): void;
}

/**
 * Sends this viewer's camera to others while it has control, at most ten times per second, and follows the camera of
 * the participant in control if the user wants to.
 */
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
      // Refusals are shown by the controls, since another participant has control now.
      if (camera !== undefined) await api.control.showCamera({ sessionId, camera }).catch(() => undefined);
    };
    this.sender = new CoalescingSender<{ camera: CameraPose }>(send, clock, () => undefined);
    participation.roles.subscribe(({ hasControl }) => {
      if (hasControl) this.sendIfMoved();
      else this.lastSent = "";
    });
  }

  /** Sends the camera if it moved since the last call; called after each drawing. */
  sendIfMoved(): void {
    if (!this.participation.roles.value.hasControl) return;
    const camera = this.camera.pose;
    const key = JSON.stringify(camera);
    if (key === this.lastSent) return;
    this.lastSent = key;
    this.sender.push({ camera });
  }

  /** Receives the camera of the participant in control. */
  receive(camera: Camera): void {
    this.remoteCamera = camera;
    this.follow();
  }

  /** Moves to the received camera if this viewer follows it. */
  follow(): void {
    const { eye, target } = this.remoteCamera ?? {};
    if (!this.participation.identity.followsCamera || this.participation.roles.value.hasControl) return;
    if (eye !== undefined && target !== undefined) this.camera.moveTo({ eye, target });
  }
}
