import { make } from "../../dom/elements";
import { resetButton } from "../../dom/rows";
import type { ChoiceControl } from "../../parameters/controls";
import type { RowEvents } from "./number_row";

/** One of several values as a person chooses it: label, list, reset. */
export class ChoiceRow {
  readonly element: HTMLElement;
  private readonly list: HTMLSelectElement;

  constructor({ field, label, help, defaultValue, options }: ChoiceControl, events: RowEvents) {
    const id = `parameter-${field}`;
    this.list = make("select", { id, title: help });
    this.list.append(...options.map(({ value, label }) => make("option", { value: String(value) }, label)));
    this.list.onchange = () => events.set(Number(this.list.value));
    this.show(defaultValue);
    const name = make("label", { htmlFor: id, title: help }, label);
    const reset = resetButton(label, () => events.reset());
    this.element = make("div", { className: "choice-row" }, name, this.list, reset);
  }

  /** Shows the session's value; a list that is open stays as it is where nothing changed. */
  show(value: number): void {
    if (this.list.value !== String(value)) this.list.value = String(value);
  }
}
