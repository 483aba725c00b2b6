import { make } from "../../dom/elements";
import type { Body } from "../../geometry/bodies";
import { t } from "../../language/translate";

/** Returns a card that explains the colour of what was filled from the generated thorax. */
export function templateLegend(color: string): HTMLElement {
  const swatch = make("span", { className: "swatch", ariaHidden: "true" });
  swatch.style.background = color;
  const words = t("Filled from the generated thorax, not seen in the scan");
  const card = make("section", { id: "template-legend", className: "card", hidden: true }, swatch, words);
  card.ariaLabel = t("Colours of the surface");
  return card;
}

/** Returns true if parts of the bodies were filled. */
export function isFilled(bodies: Body[]): boolean {
  return bodies.some(({ template }) => template?.length);
}
