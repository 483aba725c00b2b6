import { make } from "../../dom/elements";
import type { Parameters } from "../../gen/phrenic/v1/parameters_pb";
import type { Preset } from "../../gen/phrenic/v1/scene_pb";
import { activePreset, isActive, presetLabel } from "../../parameters/presets";
import type { SessionController } from "../../session/session_controller";
import { Signal } from "../../state/signal";

/**
 * A button for each preset of the scene; hidden if there are none. The active preset is pressed, and below it is said
 * what it changes.
 */
export class PresetRow {
  readonly element = make("div", { className: "presets", id: "presets", role: "group", hidden: true });
  private scene = "";
  private readonly description = make("p", { className: "preset-description", hidden: true });
  private buttons: { preset: Preset; element: HTMLButtonElement }[] = [];

  constructor(
    private readonly controller: SessionController,
    private readonly presets = new Signal<Preset[]>([]),
  ) {
    this.element.ariaLabel = "Presets";
    controller.session.subscribe((session) => {
      if (session === undefined) return;
      if (session.scene !== this.scene) void this.fill(session.scene);
      this.press(session.parameters);
    });
  }

  private async fill(scene: string): Promise<void> {
    this.scene = scene;
    const presets = await this.controller.presets();
    if (scene !== this.scene) return;
    this.buttons = presets.map((preset) => ({ preset, element: this.button(preset) }));
    this.element.replaceChildren(...this.buttons.map(({ element }) => element), this.description);
    this.element.hidden = presets.length === 0;
    this.presets.set(presets);
    this.press(this.controller.session.value?.parameters);
  }

  private button(preset: Preset): HTMLButtonElement {
    const onclick = () => void this.controller.usePreset(preset.name);
    const words = presetLabel(preset);
    return make("button", { type: "button", title: preset.description || preset.title || words, onclick }, words);
  }

  private press(parameters: Parameters | undefined): void {
    for (const { preset, element } of this.buttons) {
      element.ariaPressed = String(parameters !== undefined && isActive(preset, parameters));
    }
    const presets = this.buttons.map(({ preset }) => preset);
    this.description.textContent = activePreset(presets, parameters)?.description ?? "";
    this.description.hidden = this.description.textContent === "";
  }
}
