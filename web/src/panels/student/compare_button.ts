import { make } from "../../dom/elements";
import type { Preset } from "../../gen/phrenic/v1/scene_pb";
import type { SessionController } from "../../session/session_controller";
import type { Signal } from "../../state/signal";
import { t } from "../../language/translate";

/** What the button acts on. */
export interface HealthyComparison {
  controller: SessionController;
  presets: Signal<Preset[]>;
  /** Opens the page with this query string. */
  open(query: string): void;
  /** Closes the second view; undefined without a second view. */
  close: (() => void) | undefined;
}

/**
 * A button that shows the session beside a copy that breathes as the scene's first preset, the healthy one; with a
 * second view, it ends the comparison. Hidden for a scene without presets.
 */
export function compareButton({ controller, presets, open, close }: HealthyComparison): HTMLButtonElement {
  const words = close === undefined ? t("Compare with healthy") : t("End the comparison");
  const button = make("button", { type: "button", id: "compare-healthy", className: "primary", title: `${words} (B)` });
  button.append(words);
  presets.subscribe((all) => (button.hidden = all.length === 0 && close === undefined));
  button.onclick = async () => {
    button.disabled = true;
    if (close !== undefined) return close();
    const id = await controller.forkForComparison(presets.value[0]?.name);
    button.disabled = false;
    if (id !== undefined) open(`?${new URLSearchParams({ session: controller.sessionId, beside: id })}`);
  };
  return button;
}
