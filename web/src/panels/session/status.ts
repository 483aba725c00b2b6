import type { Link } from "../../connection/session_connection";
import type { FrameRate } from "../../frames/frame_buffer";
import type { Frame } from "../../gen/phrenic/v1/frames_pb";
import { type Session, SessionState } from "../../gen/phrenic/v1/session_pb";
import { make } from "../../dom/elements";

/** Everything that the status shows, gathered a few times a second. */
export interface Status {
  link: Link;
  session: Session | undefined;
  frame: Frame | undefined;
  rate: FrameRate;
  now: number;
}

/** The state of the connection in a pill: connecting, live with frames a second, age and error bound, or lost and retrying. */
export class LinkPill {
  readonly element = make("button", { type: "button", id: "link", className: "pill" });
  private readonly words = make("span");
  private readonly detail = make("span", { className: "detail" });

  constructor(retry: () => void) {
    this.element.append(make("span", { className: "dot" }), this.words, this.detail);
    this.element.onclick = retry;
  }

  show(status: Status): void {
    const { text, detail, title } = linkWords(status);
    this.element.dataset.link = status.link.kind;
    this.element.title = title;
    if (this.words.textContent !== text) this.words.textContent = text;
    if (this.detail.textContent !== detail) this.detail.textContent = detail;
  }
}

export function linkWords({ link, session, rate, now }: Status): { text: string; detail: string; title: string } {
  if (link.kind === "connecting") return { text: "Connecting", detail: "", title: "Waiting for the server." };
  if (link.kind === "lost") {
    const seconds = Math.max(0, Math.ceil((link.retryAt - now) / 1000));
    const detail = seconds > 0 ? `retrying in ${seconds} s` : "retrying";
    return { text: "Lost", detail, title: `${link.reason} Click to retry now.` };
  }
  const fast = rateWords(rate);
  const stopped = session?.state === SessionState.DIVERGED ? "diverged" : "paused";
  const detail = session?.state === SessionState.PLAYING ? fast : stopped;
  return { text: "Live", detail, title: rateTitle };
}

const rateTitle =
  "Frames received a second, how old they are when they come, how much later they are shown so that the picture moves " +
  "evenly between them, and how far a vertex may be from its place. " +
  "On a thin line there are fewer frames, then coarser ones.";

/** "30 fps, 12+35 ms, ±0.1 mm". */
export function rateWords({ framesPerSecond, age, delay, errorBound }: FrameRate): string {
  const words = [`${framesPerSecond} fps`];
  const held = Math.round(delay);
  if (age !== undefined) words.push(`${Math.max(0, Math.round(age))}${held > 0 ? `+${held}` : ""} ms`);
  if (errorBound > 0) words.push(`±${errorBound} mm`);
  return words.join(", ");
}

/** How many watch the session. */
export class ViewerCount {
  private readonly count = make("b", { id: "status-viewers" });
  private readonly noun = make("span");
  readonly element = make(
    "span",
    { className: "viewer-count", title: "How many watch this session" },
    this.count,
    this.noun,
  );

  show({ session }: Status): void {
    const viewers = String(session?.viewers ?? 0);
    if (this.count.textContent === viewers) return;
    this.count.textContent = viewers;
    this.noun.textContent = viewers === "1" ? " viewer" : " viewers";
  }
}

/** Time, tick, breath and pace. */
export class Readout {
  readonly element = make("div", { className: "readout", id: "readout" });
  private readonly values = new Map<string, HTMLElement>();
  private readonly bar = make("span", { className: "breath-bar" });
  private last = { phase: 0, breath: 0 };
  private inwards = true;

  constructor() {
    for (const [name, title] of fields) {
      const value = make("b", { id: `status-${name}` });
      this.values.set(name, value);
      this.element.append(make("span", { className: `reading ${name}`, title }, make("i", {}, name), value));
    }
    this.values.get("breath")?.before(make("span", { className: "breath-track", ariaHidden: "true" }, this.bar));
  }

  show({ session, frame }: Status): void {
    const digits = session?.state === SessionState.PLAYING ? 2 : 3;
    this.write("time", `${(frame?.time ?? session?.time ?? 0).toFixed(digits)} s`);
    this.write("tick", String(frame?.tick ?? session?.tick ?? 0));
    const { breath, phase } = frame ?? { breath: 0, phase: 0 };
    this.write("breath", `${this.way(phase, breath)} ${Math.floor(100 * phase)} %`);
    this.bar.style.transform = `translateX(${50 * breath}%)`;
    const pace = session?.state === SessionState.PLAYING ? (session.pace?.timesRealTime ?? 0) : 0;
    this.write("pace", `${pace.toFixed(2)}×`);
    this.write("links", residualWords(session?.constraintResidual));
    this.element.querySelector<HTMLElement>(".links")!.hidden = session?.constraintResidual === undefined;
  }

  /** Whether the breath goes in or out, by what was shown last; whoever looks back sees it the other way round. */
  private way(phase: number, breath: number): string {
    const gone = phase - this.last.phase;
    const later = gone - Math.round(gone) > 0;
    if (breath !== this.last.breath) this.inwards = breath > this.last.breath === later;
    this.last = { phase, breath };
    return this.inwards ? "in" : "out";
  }

  private write(name: string, text: string): void {
    const element = this.values.get(name);
    if (element !== undefined && element.textContent !== text) element.textContent = text;
  }
}

/** The largest violation of a constraint [m] in words; below a micrometre it is as good as kept. */
export function residualWords(metres: number | undefined): string {
  if (metres === undefined) return "";
  return metres < 1e-6 ? "kept" : `${(1000 * metres).toPrecision(2)} mm off`;
}

const fields: [string, string][] = [
  ["time", "Simulated time"],
  ["tick", "Steps since the start"],
  ["breath", "Whether the breath goes in or out, and how much of the whole breath has gone"],
  ["pace", "Simulated seconds a second"],
  ["links", "By how much the worst rigid link or limit is off; kept: less than a micrometre"],
];
