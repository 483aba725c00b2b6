import { elementById, make } from "../dom/elements";
import { t } from "../language/translate";

/**
 * Returns links before all other content that move the focus to the picture and to the controls of the present view.
 */
export function skipLinks(): HTMLElement {
  const picture = link(t("Skip to the picture"), "view", () => elementById("view"));
  const controls = link(t("Skip to the controls"), "panel", () => {
    if (document.body.classList.contains("student")) return elementById("student");
    if (!document.body.classList.contains("panel-open")) elementById("panel-toggle").click();
    return elementById("panel");
  });
  return make("nav", { id: "skip", ariaLabel: t("Skip") }, picture, controls);
}

/** The address stays as it is: it names the session. */
function link(words: string, id: string, target: () => HTMLElement): HTMLElement {
  const onclick = (event: Event) => {
    event.preventDefault();
    const element = target();
    if (!element.hasAttribute("tabindex")) element.tabIndex = -1;
    element.focus();
  };
  return make("a", { href: `#${id}`, onclick }, words);
}
