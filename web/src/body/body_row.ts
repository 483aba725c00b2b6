import { make } from "../dom/elements";
import { decimal, t } from "../language/translate";
import { ChoiceRow } from "../panels/parameters/choice_row";
import { NumberRow } from "../panels/parameters/number_row";
import type { NumberControl } from "../parameters/controls";
import { formatNumber, sliderPosition } from "../parameters/numbers";
import type { BodyControl } from "./body_numbers";
import type { BodySession } from "./body_session";

/** A row of a number that may be left to sex and age. */
class ChosenNumberRow extends NumberRow {
  /** Shows that the number is not set. */
  showUnset(control: NumberControl, neutral: number): void {
    this.show(neutral);
    this.entry.value = "";
    this.entry.placeholder = t("auto");
    this.slider.value = String(sliderPosition(control, neutral));
    this.slider.setAttribute("aria-valuetext", t("determined by sex and age"));
  }
}

/** Returns a row for a number of the body, with what it does and its range, that follows the body. */
export function bodyRow({ control, neutral, perUnit }: BodyControl, body: BodySession): HTMLElement {
  const { field } = control;
  const events = {
    set: (value: number) => body.set(field, value / perUnit),
    reset: () => body.set(field, undefined),
  };
  if (control.kind === "choice") {
    const row = new ChoiceRow(control, events);
    body.numbers.subscribe((numbers) => row.show(numbers[field] ?? control.defaultValue));
    return explained(row.element, t(control.help));
  }
  if (control.kind !== "number") throw new Error(`${field} is neither a number nor a choice.`);
  const row = new ChosenNumberRow(control, events);
  body.numbers.subscribe((numbers) => {
    const value = numbers[field];
    if (value !== undefined) row.show(value * perUnit);
    else if (neutral === undefined) row.show(control.defaultValue);
    else row.showUnset(control, neutral);
  });
  return explained(row.element, `${t(control.help)} ${rangeOf(control)}`);
}

function rangeOf({ minimum, maximum, unit }: NumberControl): string {
  const [low, high] = [minimum, maximum].map((end) => decimal(formatNumber(end)));
  return t("{0} to {1}.", low, unit === "" ? high : `${high} ${unit}`);
}

function explained(row: HTMLElement, words: string): HTMLElement {
  const help = make("p", { className: "faint" }, words);
  return make("div", { className: "body-row" }, row, help);
}
