import { make } from "../../dom/elements";
import type { Parameters } from "../../gen/phrenic/v1/parameters_pb";
import type { Preset } from "../../gen/phrenic/v1/scene_pb";
import { activePreset, isActive, presetGroups, presetLabel } from "../../parameters/presets";
import type { SessionController } from "../../session/session_controller";
import { Signal } from "../../state/signal";
import { t } from "../../language/translate";

/**
 * A button for each preset of the scene; hidden if there are none. Named groups can be folded; the one with the active
 * preset is unfolded. Above the buttons stands what the active preset changes and what to look for.
 */
export class PresetRow {
  readonly element = make("div", { className: "presets", id: "presets", role: "group", hidden: true });
  private scene = "";
  private readonly description = make("p", { className: "preset-description", hidden: true });
  private buttons: { preset: Preset; element: HTMLButtonElement }[] = [];
  private active: Preset | undefined;

  constructor(
    private readonly controller: SessionController,
    private readonly presets = new Signal<Preset[]>([]),
  ) {
    this.element.ariaLabel = t("Presets");
    this.description.setAttribute("aria-live", "polite");
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
    const groups = [...presetGroups(presets)].map(([name, members], i) => this.group(name, members, i === 0));
    this.element.replaceChildren(this.description, ...groups);
    this.element.hidden = presets.length === 0;
    // Its height stays while presets are compared, so that the buttons do not move under the pointer.
    this.description.hidden = presets.every(({ description }) => description === "");
    this.active = undefined;
    this.presets.set(presets);
    this.press(this.controller.session.value?.parameters);
  }

  /** The buttons of a group, below its name unless that is empty. */
  private group(name: string, members: Preset[], open: boolean): HTMLElement {
    const buttons = this.buttons.filter(({ preset }) => members.includes(preset)).map(({ element }) => element);
    const list = make("div", { className: "preset-list" }, ...buttons);
    if (name === "") return list;
    return make("details", { className: "preset-group", open }, make("summary", {}, t(name)), list);
  }

  private button(preset: Preset): HTMLButtonElement {
    const onclick = () => void this.controller.usePreset(preset.name);
    const words = presetLabel(preset);
    return make("button", { type: "button", title: t(preset.description) || words, onclick }, words);
  }

  private press(parameters: Parameters | undefined): void {
    for (const { preset, element } of this.buttons) {
      element.ariaPressed = String(parameters !== undefined && isActive(preset, parameters));
    }
    const presets = this.buttons.map(({ preset }) => preset);
    const active = activePreset(presets, parameters);
    this.describe(active);
    if (active === this.active) return;
    this.active = active;
    const fold = this.buttons.find(({ preset }) => preset === active)?.element.closest("details");
    if (fold) fold.open = true;
  }

  private describe(active: Preset | undefined): void {
    const words = active === undefined ? t("The parameters are those of no preset.") : t(active.description);
    if (this.description.textContent !== words) this.description.textContent = words;
  }
}
