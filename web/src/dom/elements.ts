/** Makes an element with properties (ARIA ones included) and children. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Partial<Omit<HTMLElementTagNameMap[K], "style">> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  Object.assign(element, properties);
  element.append(...children);
  return element;
}

/** The element of index.html with this id. */
export function place(id: string): HTMLElement {
  const element = document.getElementById(id);
  if (element === null) throw new Error(`index.html has no element "${id}".`);
  return element;
}

const shapes = {
  play: "M7 4.5v15l12-7.5z",
  pause: "M6.5 5h4v14h-4zM13.5 5h4v14h-4z",
  step: "M5 5v14l9-7zM16 5h3v14h-3z",
  rewind: "M12 5a7 7 0 1 1-6.7 9h2.1A5 5 0 1 0 12 7v3.6L6.6 6.300 12 2z",
  redo: "M15 5l5 5-5 5v-3.600h-5.500a3 3 0 0 0 0 6H15V20H9.500a5 5 0 0 1 0-11H15z",
  undo: "M9 5 4 10l5 5v-3.600h5.500a3 3 0 0 1 0 6H9V20h5.500a5 5 0 0 0 0-11H9z",
};

/** Hands over a file that the page made. */
export function download(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  make("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

export type IconName = keyof typeof shapes;

export function icon(name: IconName): SVGSVGElement {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(space, "path");
  path.setAttribute("d", shapes[name]);
  svg.append(path);
  return svg;
}

export function button(label: string, onclick: () => void, ...children: (Node | string)[]): HTMLButtonElement {
  return make("button", { type: "button", ariaLabel: label, title: label, onclick }, ...children);
}

/** The button beside a control called `label` that takes it back to where it started. */
export function resetButton(label: string, onclick: () => void): HTMLButtonElement {
  const reset = button(`Reset ${label.toLowerCase()}`, onclick, icon("undo"));
  reset.className = "quiet";
  return reset;
}

/** A section of the panel that folds away. */
export function section(title: string, open: boolean, ...children: (Node | string)[]): HTMLDetailsElement {
  return make("details", { open, className: "section" }, make("summary", {}, title), ...children);
}

/** A checkbox that looks like a switch, with its words. */
export function switchRow(label: string, help: string, onchange: (on: boolean) => void) {
  const input = make("input", { type: "checkbox", className: "switch" });
  input.setAttribute("role", "switch");
  input.onchange = () => onchange(input.checked);
  const row = make("label", { className: "switch-row", title: help }, make("span", {}, label), input);
  return { row, input };
}
