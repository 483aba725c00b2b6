import { elementById, make } from "../dom/elements";
import type { Fluoroscope, FluoroscopeParts } from "../fluoroscopy/fluoroscope";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import type { Preset } from "../gen/phrenic/v1/scene_pb";
import { SessionState } from "../gen/phrenic/v1/session_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import { withoutPattern } from "../parameters/patterns";
import type { SessionController } from "../session/session_controller";
import type { Signal } from "../state/signal";
import { drawsInSoftware } from "../viewer/quality";
import type { Viewer } from "../viewer/viewer";
import { t } from "../language/translate";

/** What the fluoroscopy acts on. */
export interface FluoroscopyParts {
  viewer: Viewer;
  controller: SessionController;
  presets: Signal<Preset[]>;
  bodies(): Body[];
  frame(): FrameArrays | undefined;
  /** Returns why this viewer may not change the session; empty if it may. */
  refusal(): string;
  /** Called when it is opened or closed. */
  changed(): void;
}

/** The button that opens the picture by X-rays over the 3D view; its code is loaded then. */
export class Fluoroscopy {
  readonly button = make("button", { type: "button", id: "fluoroscopy-open", hidden: true }, t("X-ray"));
  private shown: Fluoroscope | undefined;

  constructor(private readonly parts: FluoroscopyParts) {
    this.button.title = t("Fluoroscopy: the breathing thorax as X-rays show it (X)");
    this.button.onclick = () => void this.toggle();
  }

  /** True while the picture is shown. */
  get isOpen(): boolean {
    return this.shown !== undefined;
  }

  /** The picture; undefined while it is not shown. */
  get picture(): Fluoroscope | undefined {
    return this.shown;
  }

  /** Starts another scene; the button is hidden for scenes without lungs. */
  start(bodies: Body[]): void {
    this.close();
    this.button.hidden = !bodies.some(
      ({ name, layer, triangles }) => triangles.length > 0 && /lung/.test(name + layer),
    );
  }

  /** Opens or closes the picture. */
  async toggle(): Promise<void> {
    if (this.shown !== undefined) return this.close();
    this.button.disabled = true;
    const { Fluoroscope } = await import("../fluoroscopy/fluoroscope");
    this.button.disabled = false;
    const { viewer, frame, bodies } = this.parts;
    const [redraw, close] = [() => viewer.refresh(), () => this.close()];
    const parts = { bodies: bodies(), software: drawsInSoftware(), sniff: this.sniffActions(), frame, redraw, close };
    this.shown = new Fluoroscope(parts);
    elementById("stage").append(this.shown.element);
    elementById("stage").classList.add("in-fluoroscopy");
    viewer.setCovered(true);
    this.parts.changed();
    this.shown.focus();
  }

  /** Closes the picture. */
  close(): void {
    if (this.shown === undefined) return;
    this.shown.dispose();
    this.shown = undefined;
    elementById("stage").classList.remove("in-fluoroscopy");
    this.parts.viewer.setCovered(false);
    this.parts.changed();
    this.button.focus();
  }

  /** Receives every frame. */
  receive(frame: Frame): void {
    this.shown?.receive(frame);
  }

  /** Draws the present frame. */
  draw(): void {
    this.shown?.draw();
  }

  /** A sniff keeps what is ill: nerves, lungs, wall and posture stay as they are. */
  private sniffActions(): FluoroscopeParts["sniff"] {
    const { controller, presets, refusal } = this.parts;
    const preset = presets.value.find(({ name }) => name === "sniff");
    if (preset?.parameters === undefined) return undefined;
    let before = controller.session.value?.parameters;
    return {
      refusal,
      start: async () => {
        const { session } = controller;
        const now = session.value?.parameters;
        if (now === undefined || preset.parameters === undefined) return;
        if (!sniffs(preset, now)) before = now;
        await controller.usePreset(preset.name, withoutPattern(preset.parameters, now));
        if (session.value?.state !== SessionState.PLAYING) await controller.play(1);
      },
      stop: () => (before === undefined ? Promise.resolve() : controller.apply(before)),
    };
  }
}

/** True if a session breathes as the preset does. */
function sniffs({ parameters }: Preset, now: NonNullable<Preset["parameters"]>): boolean {
  return parameters?.breathLength === now.breathLength && parameters?.pauseShare === now.pauseShare;
}
