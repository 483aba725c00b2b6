import { make } from "../../dom/elements";
import type { Frame } from "../../gen/phrenic/v1/frames_pb";
import { type Session, SessionState } from "../../gen/phrenic/v1/session_pb";
import { decimal, fixed, t } from "../../language/translate";

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
      this.element.append(
        make("span", { className: `reading ${name}`, title: t(title) }, make("i", {}, t(name)), value),
      );
    }
    this.values.get("breath")?.before(make("span", { className: "breath-track", ariaHidden: "true" }, this.bar));
  }

  /** Shows a frame or, without one, the state of the session. */
  show({ session, frame }: { session: Session | undefined; frame: Frame | undefined }): void {
    const digits = session?.state === SessionState.PLAYING ? 2 : 3;
    this.write("time", `${fixed(frame?.time ?? session?.time ?? 0, digits)} s`);
    this.write("tick", String(frame?.tick ?? session?.tick ?? 0));
    const { breath, phase } = frame ?? { breath: 0, phase: 0 };
    this.write("breath", `${this.breathDirection(phase, breath)} ${Math.floor(100 * phase)} %`);
    this.bar.style.transform = `translateX(${50 * breath}%)`;
    const pace = session?.state === SessionState.PLAYING ? (session.pace?.timesRealTime ?? 0) : 0;
    this.write("pace", `${fixed(pace, 2)}×`);
    const applied = session?.parameters?.applyLinks ?? true;
    this.write("links", applied ? residualLabel(session?.constraintResidual) : t("switched off"));
    this.element.querySelector<HTMLElement>(".links")!.hidden = session?.constraintResidual === undefined;
  }

  /** Returns whether the breath goes in or out, from the change since the last call; replay may go backwards. */
  private breathDirection(phase: number, breath: number): string {
    const gone = phase - this.last.phase;
    const later = gone - Math.round(gone) > 0;
    if (breath !== this.last.breath) this.inwards = breath > this.last.breath === later;
    this.last = { phase, breath };
    return this.inwards ? t("in") : t("out");
  }

  private write(name: string, text: string): void {
    const element = this.values.get(name);
    if (element !== undefined && element.textContent !== text) element.textContent = text;
  }
}

/** Returns the largest constraint violation [m] as text; "kept" below a micrometre. */
export function residualLabel(metres: number | undefined): string {
  if (metres === undefined) return "";
  if (metres < 1e-6) return t("kept");
  return t(metres < 1e-4 ? "{0} mm at most" : "{0} mm off", decimal((1000 * metres).toPrecision(2)));
}

const fields: [string, string][] = [
  ["time", "Simulated time"],
  ["tick", "Steps since the start"],
  ["breath", "Inspiration or expiration, and the phase of the breath"],
  ["pace", "Simulated seconds per second"],
  ["links", "Largest violation of a rigid link or limit; kept: below 1 µm; off: above 0.1 mm"],
];
