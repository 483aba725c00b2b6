import { make } from "../../dom/elements";
import { resetButton } from "../../dom/rows";
import type { ChoiceControl } from "../../parameters/controls";
import type { RowEvents } from "./number_row";
import { t } from "../../language/translate";

/** A row to select one of several values: label, list, reset. */
export class ChoiceRow {
  readonly element: HTMLElement;
  private readonly list: HTMLSelectElement;

  constructor({ field, label, help, defaultValue, options }: ChoiceControl, events: RowEvents) {
    const id = `parameter-${field}`;
    this.list = make("select", { id, title: t(help) });
    this.list.append(...options.map(({ value, label }) => make("option", { value: String(value) }, t(label))));
    this.list.onchange = () => events.set(Number(this.list.value));
    this.show(defaultValue);
    const name = make("label", { htmlFor: id, title: t(help) }, t(label));
    const reset = resetButton(t(label), () => events.reset());
    this.element = make("div", { className: "choice-row" }, name, this.list, reset);
  }

  /** Shows the session's value; does not disturb an open list if the value is unchanged. */
  show(value: number): void {
    if (this.list.value !== String(value)) this.list.value = String(value);
  }
}
