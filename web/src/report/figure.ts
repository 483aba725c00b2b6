import { legend } from "@observablehq/plot";
import { make } from "../panels/dom";
import { seriesScales } from "./axes";
import type { Look } from "./names";

/** A plot with the sentence that says what to see. */
export function figure(title: string, sentence: string, ...content: (Node | string)[]): HTMLElement {
  const caption = make("figcaption", {}, make("strong", {}, title), ` ${sentence}`);
  return make("figure", {}, ...content, caption);
}

/** The series' symbols and names. */
export function key(looks: Map<string, Look>): HTMLElement {
  const { color, symbol } = seriesScales(looks);
  const names = (id: string) => looks.get(id)?.name ?? id;
  const drawn = legend({
    color,
    symbol: { ...symbol, legend: true },
    fill: "color",
    tickFormat: names,
    className: "key",
    swatchSize: 16,
  });
  drawn.setAttribute("aria-hidden", "true");
  return make("div", { className: "key-row" }, drawn);
}

/** Figures side by side where there is room. */
export function beside(...figures: (HTMLElement | undefined)[]): HTMLElement {
  return make("div", { className: "beside" }, ...figures.filter((each) => each !== undefined));
}
