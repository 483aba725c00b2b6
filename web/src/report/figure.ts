import { make } from "../dom/elements";

/** A plot with the sentence that says what to see. */
export function figure(title: string, sentence: string, ...content: (Node | string)[]): HTMLElement {
  const caption = make("figcaption", {}, make("strong", {}, title), ` ${sentence}`);
  return make("figure", {}, ...content, caption);
}

/** Figures side by side where there is room. */
export function sideBySide(...figures: (HTMLElement | undefined)[]): HTMLElement {
  return make("div", { className: "beside" }, ...figures.filter((each) => each !== undefined));
}
