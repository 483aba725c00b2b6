import { make } from "../../dom/elements";
import type { Frame } from "../../gen/phrenic/v1/frames_pb";
import type { Preset } from "../../gen/phrenic/v1/scene_pb";
import { domeHeights, domeHelp } from "../../graphs/catalogue";
import { differences, shortDifferences } from "../../parameters/differences";
import { activeLabel } from "../../parameters/presets";
import type { SessionController } from "../../session/session_controller";
import type { Signal } from "../../state/signal";
import { fixed, t } from "../../language/translate";

/** Smallest time difference between the views that is shown [s]. */
const maxTimeDifference = 0.05;

interface Actions {
  swap(): void;
  close(): void;
}

/** Headers of two views: preset, time, dome descent, and how the parameters of the second session differ. */
export class ViewHeaders {
  readonly element: HTMLElement;
  /** The names of the active presets; otherwise the session ids. */
  private readonly names = [make("b"), make("b")];
  private readonly times = [make("span", { className: "time" }), make("span", { className: "time" })];
  private readonly domes = [0, 1].map(() => make("span", { className: "domes", title: t(domeHelp) }));
  private readonly differences = make("span", { className: "differences" });

  constructor(
    private readonly pair: [SessionController, SessionController],
    private readonly presets: Signal<Preset[]>,
    actions: Actions,
  ) {
    const steered = make("span", { className: "faint", title: t("The controls act on this session") }, t("active"));
    const viewHeaders = [[steered], buttons(pair[1].sessionId, actions)].map((extra, i) =>
      make("div", { className: "view-header", title: pair[i].sessionId }, this.names[i], this.times[i], ...extra),
    );
    this.domes.forEach((domes, i) => viewHeaders[i].append(domes));
    viewHeaders[1].append(this.differences);
    this.element = make("div", { id: "view-headers" }, ...viewHeaders);
    for (const { session } of pair) session.subscribe(() => this.compare());
    presets.subscribe(() => this.compare());
  }

  /** Shows the times and dome heights of both frames. */
  update(frames: [Frame | undefined, Frame | undefined]): void {
    const [here, there] = frames.map((frame) => frame?.time ?? 0);
    frames.forEach((frame, i) => (this.domes[i].textContent = domeLabel(frame)));
    this.times[0].textContent = `${fixed(here, 2)} s`;
    const timeDifference = there - here;
    const words =
      Math.abs(timeDifference) < maxTimeDifference
        ? ""
        : t(timeDifference > 0 ? ", {0} s ahead" : ", {0} s behind", fixed(Math.abs(timeDifference), 1));
    this.times[1].textContent = `${fixed(there, 2)} s${words}`;
  }

  private compare(): void {
    const [here, there] = this.pair.map(({ session }) => session.value?.parameters);
    this.pair.forEach(({ session, sessionId }, i) => {
      this.names[i].textContent = activeLabel(this.presets.value, session.value?.parameters) ?? sessionId;
    });
    this.differences.textContent = shortDifferences(here, there) || t("Same parameters");
    this.differences.title = differences(here, there);
  }
}

function buttons(sessionId: string, { swap, close }: Actions): HTMLElement[] {
  const button = (words: string, title: string, onclick: () => void) =>
    make("button", { type: "button", className: "small", title, onclick }, words);
  return [
    button(t("Activate"), t("Let the controls act on this session"), swap),
    button(t("Close"), t("Close this view; {0} stays on the server", sessionId), close),
  ];
}

/** Returns "right dome 19.5 mm down, left dome 2.1 mm up"; empty if the scene has no dome. */
export function domeLabel(frame: Frame | undefined): string {
  if (frame === undefined) return "";
  return domeHeights(frame)
    .map(({ name, height }) => {
      const way = fixed(1000 * Math.abs(height), 1);
      const words =
        Number((1000 * height).toFixed(1)) === 0 ? "{0} {1} mm" : height > 0 ? "{0} {1} mm up" : "{0} {1} mm down";
      return t(words, t(name), way);
    })
    .join(", ");
}
