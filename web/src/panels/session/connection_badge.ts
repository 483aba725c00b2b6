import type { ConnectionState } from "../../connection/session_connection";
import { make } from "../../dom/elements";
import type { FrameRate } from "../../frames/frame_buffer";
import type { Frame } from "../../gen/phrenic/v1/frames_pb";
import { type Session, SessionState } from "../../gen/phrenic/v1/session_pb";
import { decimal, t } from "../../language/translate";

/** The values that the status displays show, collected a few times per second. */
export interface Status {
  connection: ConnectionState;
  session: Session | undefined;
  frame: Frame | undefined;
  rate: FrameRate;
  now: number;
}

/** The connection state: connecting, live with frame rate, age and error bound, or lost and retrying. */
export class ConnectionBadge {
  readonly element = make("button", { type: "button", id: "connection", className: "pill" });
  private readonly words = make("span");
  private readonly detail = make("span", { className: "detail" });

  constructor(retry: () => void) {
    this.element.append(make("span", { className: "dot" }), this.words, this.detail);
    this.element.onclick = retry;
  }

  /** Shows the state of the connection. */
  show(status: Status): void {
    const { text, detail, title } = connectionLabels(status);
    this.element.dataset.state = status.connection.kind;
    this.element.title = title;
    if (this.words.textContent !== text) this.words.textContent = text;
    if (this.detail.textContent !== detail) this.detail.textContent = detail;
  }
}

/** Returns text, detail and tooltip of the badge. */
export function connectionLabels({ connection, session, rate, now }: Status): {
  text: string;
  detail: string;
  title: string;
} {
  if (connection.kind === "connecting")
    return { text: t("Connecting"), detail: "", title: t("Waiting for the server.") };
  if (connection.kind === "lost") {
    const seconds = Math.max(0, Math.ceil((connection.retryAt - now) / 1000));
    const detail = seconds > 0 ? t("retrying in {0} s", seconds) : t("retrying");
    return { text: t("Lost"), detail, title: `${connection.reason} ${t("Click to retry now.")}` };
  }
  const fast = rateLabel(rate);
  const stopped = session?.state === SessionState.DIVERGED ? t("diverged") : t("paused");
  const detail = session?.state === SessionState.PLAYING ? fast : stopped;
  return { text: t("Live"), detail, title: t(rateTitle) };
}

const rateTitle =
  "Frames per second, their age at arrival plus the display delay that smooths the motion, and the largest position error. On a slow connection there are fewer frames, then less accurate ones.";

/** Returns "30 fps, 12+35 ms, ±0.1 mm": rate, age plus display delay, error bound. */
export function rateLabel({ framesPerSecond, age, delay, errorBound }: FrameRate): string {
  const words = [`${framesPerSecond} fps`];
  const held = Math.round(delay);
  if (age !== undefined) words.push(`${Math.max(0, Math.round(age))}${held > 0 ? `+${held}` : ""} ms`);
  if (errorBound > 0) words.push(`±${decimal(String(errorBound))} mm`);
  return words.join(", ");
}

/** The number of viewers of the session. */
export class ViewerCount {
  private readonly count = make("b", { id: "status-viewers" });
  private readonly noun = make("span");
  readonly element = make(
    "span",
    { className: "viewer-count", title: t("Number of viewers of this session") },
    this.count,
    this.noun,
  );

  /** Shows the number of viewers. */
  show({ session }: Status): void {
    const viewers = String(session?.viewers ?? 0);
    if (this.count.textContent === viewers) return;
    this.count.textContent = viewers;
    this.noun.textContent = viewers === "1" ? t(" viewer") : t(" viewers");
  }
}
