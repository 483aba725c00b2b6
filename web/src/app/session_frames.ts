import { WorkerDecoding } from "../decoders/worker_decoding";
import { FrameBuffer } from "../frames/frame_buffer";
import { t } from "../language/translate";
import type { SessionController } from "../session/session_controller";

/** Returns the frames of a session, decoded in a worker; `controller` reports those that cannot be. */
export function sessionFrames(controller: () => SessionController): FrameBuffer {
  return new FrameBuffer(new WorkerDecoding(), ({ message }) =>
    controller().notice.set(t("A frame cannot be shown: {0}", message)),
  );
}
