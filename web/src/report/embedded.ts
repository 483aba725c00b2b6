import { make } from "../dom/elements";
import type { Study } from "../gen/phrenic/v1/study_pb";
import { contentsOf } from "./page";
import css from "./report.css?inline";

/** Shows a study within another page, in a shadow root that isolates the styles of both. */
export function embed(host: HTMLElement, study: Study): void {
  const root = host.shadowRoot ?? host.attachShadow({ mode: "open" });
  const sheet = new CSSStyleSheet();
  // Selectors for the root and body of a standalone page apply to the host element here.
  sheet.replaceSync(css.replaceAll(":root", ":host").replaceAll(/(^|\s)body(?=\s*\{)/g, "$1:host"));
  root.adoptedStyleSheets = [sheet];
  root.replaceChildren(make("article", { className: "page" }, ...contentsOf(study)));
}
