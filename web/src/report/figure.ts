import { make } from "../dom/elements";

/** A plot with its caption. */
export function figure(title: string, sentence: string, ...content: (Node | string)[]): HTMLElement {
  const caption = make("figcaption", {}, make("strong", {}, title), ` ${sentence}`);
  return make("figure", {}, ...content, caption);
}

/** Figures side by side if there is room. */
export function sideBySide(...figures: (HTMLElement | undefined)[]): HTMLElement {
  return make("div", { className: "side-by-side" }, ...figures.filter((each) => each !== undefined));
}
