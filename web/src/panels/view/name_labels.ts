import { make } from "../../dom/elements";
import { oneTabStop } from "../../dom/toolbar";
import type { VertexRef } from "../../geometry/vertices";
import type { NameLabel } from "../../viewer/names";
import { t } from "../../language/translate";

/** Mean width of a character of a name [CSS pixels]. */
const letterWidth = 6.8;

/** The names beside the scene; those of structures are buttons among which the arrow keys move. */
export class NameLabels {
  readonly element = make("div", {
    className: "name-labels",
    ariaLabel: t("Names of visible structures"),
    hidden: true,
  });
  /** Text of the name that had the focus before the names were hidden. */
  private kept: string | undefined;
  private readonly changed = oneTabStop(this.element);

  constructor(private readonly choose: (vertex: VertexRef) => void) {}

  /** Replaces all names. The focus stays on the same name. */
  show(labels: NameLabel[]): void {
    if (this.element.contains(document.activeElement)) this.kept = document.activeElement?.textContent ?? undefined;
    this.element.hidden = labels.length === 0;
    this.element.replaceChildren(...labels.map((each) => this.label(each)));
    this.changed();
    if (labels.length === 0 || this.kept === undefined) return;
    const same = [...this.element.querySelectorAll("button")].find(({ textContent }) => textContent === this.kept);
    if (document.activeElement === document.body) same?.focus();
    this.kept = undefined;
  }

  private label({ name, latin, structure, ref, side, x, y, width, height }: NameLabel): HTMLElement {
    const words = [make("span", {}, name)];
    // A long name takes the line of the Latin one, which the title has.
    if (latin !== "" && letterWidth * name.length < width - 12)
      words.push(make("span", { className: "latin", lang: "la" }, latin));
    const element = structure
      ? make("button", { type: "button", title: latin, onclick: () => this.choose(ref) }, ...words)
      : make("span", {}, ...words);
    element.className = `name-label ${side}`;
    element.classList.toggle("narrow", height > 40);
    Object.assign(element.style, {
      left: `${side === "left" ? x - width : x}px`,
      top: `${y - height / 2}px`,
      width: `${width}px`,
      height: `${height}px`,
    });
    return element;
  }
}
