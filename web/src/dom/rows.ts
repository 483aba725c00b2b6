import { button, make } from "./elements";
import { icon } from "./icons";
import { lower, t } from "../language/translate";

/** Returns a button that resets the control with this label. */
export function resetButton(label: string, onclick: () => void): HTMLButtonElement {
  const reset = button(t("Reset {0}", lower(label)), onclick, icon("undo"));
  reset.className = "quiet";
  return reset;
}

/** Returns a collapsible section of the panel. */
export function section(title: string, open: boolean, ...children: (Node | string)[]): HTMLDetailsElement {
  return make("details", { open, className: "section" }, make("summary", {}, title), ...children);
}

/** Calls `load` when a section is opened for the first time: what the first picture does not need is loaded then. */
export function loadOnOpen(section: HTMLDetailsElement, load: () => Promise<void>): HTMLDetailsElement {
  section.addEventListener("toggle", () => void load(), { once: true });
  return section;
}

/** Returns a labelled checkbox that looks like a switch. */
export function switchRow(label: string, help: string, onchange: (on: boolean) => void) {
  const input = make("input", { type: "checkbox", className: "switch" });
  input.setAttribute("role", "switch");
  input.onchange = () => onchange(input.checked);
  const row = make("label", { className: "switch-row", title: help }, make("span", {}, label), input);
  return { row, input };
}

/** Returns a row with a label and the control that has this id. */
export function labelledRow(id: string, label: string, control: HTMLElement): HTMLDivElement {
  return make("div", { className: "labelled-row" }, make("label", { htmlFor: id }, label), control);
}

/** Returns a paragraph that screen readers announce as an error. */
export function alertMessage(message: string): HTMLParagraphElement {
  const element = make("p", { className: "fault" }, message);
  element.setAttribute("role", "alert");
  return element;
}
