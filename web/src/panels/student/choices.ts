import { make } from "../../dom/elements";
import { oneTabStop } from "../../dom/toolbar";
import type { Parameters } from "../../gen/phrenic/v1/parameters_pb";
import type { Preset } from "../../gen/phrenic/v1/scene_pb";
import { presetCauses } from "../../parameters/causes";
import { activePreset, presetLabel } from "../../parameters/presets";
import type { SessionController } from "../../session/session_controller";
import type { Signal } from "../../state/signal";
import { t } from "../../language/translate";

/** Choices of a cause that are shown before "More" is pressed. */
const shownAtFirst = 8;

/** Large buttons that choose a preset, grouped by cause: health, illness, a machine. */
export class Choices {
  readonly element = make("section", { id: "choices", ariaLabel: t("Choose a breath"), hidden: true });
  private readonly causes = make("div", { className: "causes", ariaLabel: t("Cause") });
  private readonly list = make("div", { className: "choice-list" });
  private readonly description = make("p", { id: "choice-description" });
  private readonly tabStops = [oneTabStop(this.causes), oneTabStop(this.list)];
  private members = new Map<string, Preset[]>();
  private cause = "";
  private unfolded = false;
  private active: Preset | undefined;

  constructor(
    private readonly controller: SessionController,
    presets: Signal<Preset[]>,
  ) {
    this.element.append(this.causes, this.list, this.description);
    presets.subscribe((all) => {
      this.members = presetCauses(all);
      this.element.hidden = all.length === 0;
      this.active = undefined;
      this.show([...this.members.keys()][0] ?? "");
      this.follow(all, controller.session.value?.parameters);
    });
    controller.session.subscribe((session) => this.follow(presets.value, session?.parameters));
  }

  /** Shows the cause of the active preset when another one becomes active. */
  private follow(all: Preset[], parameters: Parameters | undefined): void {
    const active = activePreset(all, parameters);
    this.description.textContent =
      active === undefined ? t("Your own breath, by the three sliders.") : t(active.description);
    if (active !== this.active) {
      this.active = active;
      const [cause, members] = [...this.members].find(([, each]) => active && each.includes(active)) ?? [
        this.cause,
        [],
      ];
      this.unfolded ||= active !== undefined && members.indexOf(active) >= shownAtFirst;
      this.show(cause);
    }
    for (const button of this.list.querySelectorAll<HTMLElement>("[data-preset]"))
      button.ariaPressed = String(button.dataset.preset === active?.name);
    for (const update of this.tabStops) update();
  }

  private show(cause: string): void {
    const focused = (document.activeElement as HTMLElement | null)?.dataset?.preset;
    this.cause = cause;
    this.causes.replaceChildren(...[...this.members.keys()].map((each) => this.causeButton(each)));
    const members = this.members.get(cause) ?? [];
    const shown = this.unfolded ? members : members.slice(0, shownAtFirst);
    this.list.ariaLabel = t(cause);
    this.list.replaceChildren(...shown.map((preset) => this.presetButton(preset)));
    if (members.length > shownAtFirst) this.list.append(this.moreButton(members.length - shownAtFirst));
    // A choice keeps the focus when the list is written again.
    if (focused !== undefined) this.list.querySelector<HTMLElement>(`[data-preset="${CSS.escape(focused)}"]`)?.focus();
    for (const update of this.tabStops) update();
  }

  private causeButton(cause: string): HTMLElement {
    const onclick = () => {
      this.unfolded = false;
      this.show(cause);
      this.causes.querySelector<HTMLElement>('[aria-pressed="true"]')?.focus();
    };
    return make("button", { type: "button", ariaPressed: String(cause === this.cause), onclick }, t(cause));
  }

  private presetButton(preset: Preset): HTMLElement {
    const onclick = () => void this.controller.usePreset(preset.name);
    const ariaPressed = String(preset === this.active);
    const element = make("button", { type: "button", title: t(preset.description), ariaPressed, onclick });
    element.append(presetLabel(preset));
    element.dataset.preset = preset.name;
    return element;
  }

  private moreButton(count: number): HTMLElement {
    const onclick = () => {
      this.unfolded = !this.unfolded;
      this.show(this.cause);
      this.list.querySelector<HTMLElement>(".more")?.focus();
    };
    const ariaExpanded = String(this.unfolded);
    const words = this.unfolded ? t("Fewer") : t("{0} more", count);
    return make("button", { type: "button", className: "more", ariaExpanded, onclick }, words);
  }
}
