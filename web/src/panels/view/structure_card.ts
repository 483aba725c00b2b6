import type { Structure } from "../../anatomy/structures";
import { make } from "../../dom/elements";
import type { Signal } from "../../state/signal";
import { t } from "../../language/translate";

/** What the card does with the chosen structure. */
export interface StructureActions {
  /** Flies to the structure and fades all others. */
  isolate(structure: Structure): void;
  /** Shows all structures again. */
  showAll(): void;
  /** Measures the structure; the card has no button for it if not set. */
  measure?: ((structure: Structure) => void) | undefined;
}

/** A card with the name of the chosen structure and its definition. */
export function structureCard(
  chosen: Signal<Structure | undefined>,
  isolated: Signal<Structure | undefined>,
  { isolate, showAll, measure }: StructureActions,
): HTMLElement {
  const name = make("h2");
  const latin = make("p", { className: "latin", lang: "la" });
  const definition = make("p");
  const filled = make("p", { className: "fault", id: "structure-filled" });
  const alone = make("button", { type: "button", id: "structure-alone" });
  const close = make("button", { type: "button", onclick: () => chosen.set(undefined) }, t("Close"));
  const size = make(
    "button",
    { type: "button", id: "structure-measure", title: t("Area, and volume if closed") },
    t("Measure"),
  );
  size.onclick = () => chosen.value && measure?.(chosen.value);
  const buttons = measure === undefined ? [alone, close] : [alone, size, close];
  const card = make("section", { id: "structure", className: "card", ariaLabel: t("Structure") });
  alone.onclick = () => {
    if (isolated.value !== undefined) showAll();
    else if (chosen.value !== undefined) isolate(chosen.value);
  };
  card.append(name, latin, definition, filled, make("div", { className: "row" }, ...buttons));
  chosen.subscribe((structure) => {
    card.hidden = structure === undefined;
    name.textContent = structure?.name ?? "";
    latin.textContent = structure?.latin ?? "";
    definition.textContent = structure?.definition ?? "";
    const percent = Math.round(100 * (structure?.filled ?? 0));
    filled.textContent = t("{0} % of it is filled from the generated thorax, not seen in the scan.", percent);
    filled.hidden = percent === 0;
  });
  isolated.subscribe((structure) => {
    alone.textContent = structure === undefined ? t("Show alone") : t("Show all");
    alone.title =
      structure === undefined ? t("Fly to it and fade all others") : t("Show all structures again (Escape)");
  });
  return card;
}
