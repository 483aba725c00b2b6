import { make } from "../../dom/elements";
import { resetButton } from "../../dom/rows";
import type { NumberControl } from "../../parameters/controls";
import { faultOf, formatNumber, positionOf, valueAt } from "../../parameters/numbers";

/** What a row tells its owner. */
export interface RowEvents {
  /** The person set `value`. */
  set(value: number): void;
  reset(): void;
}

/** A number as a person sets it: label, slider, typed entry, unit, reset, and a word where the entry is refused. */
export class NumberRow {
  readonly element: HTMLElement;
  private readonly slider: HTMLInputElement;
  private readonly entry: HTMLInputElement;
  private readonly fault: HTMLElement;
  private held = false;

  constructor(
    private readonly control: NumberControl,
    private readonly events: RowEvents,
  ) {
    const id = `parameter-${control.field}`;
    this.slider = this.makeSlider(id);
    this.entry = make("input", { type: "number", step: "any", id: `${id}-entry` });
    this.entry.ariaLabel = `${control.label}${control.unit ? ` in ${control.unit}` : ""}`;
    this.entry.onchange = () => this.typed();
    this.fault = make("p", { className: "fault", id: `${id}-fault` });
    this.fault.setAttribute("role", "alert");
    this.element = make(
      "div",
      { className: "number-row" },
      make("label", { htmlFor: id, title: control.help }, control.label),
      make("span", { className: "entry" }, this.entry, make("span", { className: "unit" }, control.unit)),
      this.slider,
      resetButton(control.label, () => events.reset()),
      this.fault,
    );
  }

  private makeSlider(id: string): HTMLInputElement {
    const { control } = this;
    const slider = make("input", { type: "range", id, title: control.help });
    slider.min = String(positionOf(control, control.minimum));
    slider.max = String(positionOf(control, control.maximum));
    slider.step = String(control.step);
    slider.oninput = () => {
      const value = valueAt(control, slider.valueAsNumber);
      this.write(value);
      this.events.set(value);
    };
    slider.onpointerdown = () => (this.held = true);
    slider.onpointerup = slider.onpointercancel = slider.onblur = () => (this.held = false);
    return slider;
  }

  /** Shows the session's value, unless the person has this very row in hand. */
  show(value: number): void {
    if (this.held || document.activeElement === this.entry) return;
    this.slider.value = String(positionOf(this.control, value));
    this.write(value);
  }

  private write(value: number): void {
    this.entry.value = formatNumber(value);
    const unit = this.control.unit ? ` ${this.control.unit}` : "";
    this.slider.setAttribute("aria-valuetext", formatNumber(value) + unit);
    this.slider.style.setProperty("--filled", `${(100 * this.filled(value)).toFixed(1)}%`);
    this.complain(undefined);
  }

  private filled(value: number): number {
    const [low, high] = [this.control.minimum, this.control.maximum].map((end) => positionOf(this.control, end));
    return (positionOf(this.control, value) - low) / (high - low);
  }

  private typed(): void {
    const value = this.entry.valueAsNumber;
    const fault = faultOf(this.control, value);
    this.complain(fault);
    if (fault !== undefined) return;
    this.slider.value = String(positionOf(this.control, value));
    this.events.set(value);
  }

  private complain(fault: string | undefined): void {
    this.fault.textContent = fault ?? "";
    this.entry.setAttribute("aria-invalid", String(fault !== undefined));
  }
}
