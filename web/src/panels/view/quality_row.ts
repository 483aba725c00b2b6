import { make } from "../../dom/elements";
import { labelledRow } from "../../dom/rows";
import { ownStorage } from "../../dom/storage";
import { Signal } from "../../state/signal";
import { type Quality, qualities } from "../../viewer/quality";
import { t } from "../../language/translate";

/** What a picture may cost; undefined to choose by the measured time of a drawing. */
export type QualityChoice = Quality | undefined;

const key = "phrenic-quality";
const labels: [QualityChoice, string][] = [
  [undefined, "Automatic"],
  ["full", "Full: shadows"],
  ["balanced", "Balanced"],
  ["plain", "Plain: fastest"],
];

/** Returns the quality that the browser remembers, and remembers it from now on. */
export function rememberedQuality(memory: Pick<Storage, "getItem" | "setItem"> = ownStorage): Signal<QualityChoice> {
  const quality = new Signal<QualityChoice>(qualities.find((each) => each === memory.getItem(key)));
  quality.subscribe((chosen) => memory.setItem(key, chosen ?? "automatic"));
  return quality;
}

/** A row that chooses the quality of the picture. */
export function qualityRow(quality: Signal<QualityChoice>): HTMLElement {
  const list = make("select", { id: "quality", title: t("Lights and shadows: a slow machine draws plainer pictures") });
  list.append(...labels.map(([value, label]) => make("option", { value: value ?? "automatic" }, t(label))));
  list.onchange = () => quality.set(qualities.find((each) => each === list.value));
  quality.subscribe((chosen) => (list.value = chosen ?? "automatic"));
  return labelledRow("quality", t("Picture"), list);
}
