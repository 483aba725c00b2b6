/** Creates an element with properties (including ARIA ones) and children. */
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

/** Returns the element of index.html with this id. Throws Error if there is none. */
export function elementById(id: string): HTMLElement {
  const element = document.getElementById(id);
  if (element === null) throw new Error(`index.html has no element "${id}".`);
  return element;
}

/** Creates a button with a label for tooltip and screen readers. */
export function button(label: string, onclick: () => void, ...children: (Node | string)[]): HTMLButtonElement {
  return make("button", { type: "button", ariaLabel: label, title: label, onclick }, ...children);
}
