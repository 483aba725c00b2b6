import { make } from "../../dom/elements";
import { resetButton } from "../../dom/rows";
import type { NumberControl } from "../../parameters/controls";
import { formatNumber, rangeError, sliderPosition, sliderValue } from "../../parameters/numbers";
import { decimal, t } from "../../language/translate";

/** Events of a row. */
export interface RowEvents {
  /** The user set `value`. */
  set(value: number): void;
  reset(): void;
}

/** A row to set a number: label, slider, entry, unit, reset, and an error message for invalid entries. */
export class NumberRow {
  readonly element: HTMLElement;
  protected readonly slider: HTMLInputElement;
  protected readonly entry: HTMLInputElement;
  private readonly fault: HTMLElement;
  private dragging = false;

  constructor(
    private readonly control: NumberControl,
    private readonly events: RowEvents,
  ) {
    const id = `parameter-${control.field}`;
    this.slider = this.makeSlider(id);
    this.entry = make("input", { type: "number", step: "any", id: `${id}-entry` });
    this.entry.ariaLabel = control.unit ? t("{0} in {1}", t(control.label), control.unit) : t(control.label);
    this.entry.onchange = () => this.onEntry();
    this.fault = make("p", { className: "fault", id: `${id}-fault` });
    this.fault.setAttribute("role", "alert");
    this.element = make(
      "div",
      { className: "number-row" },
      make("label", { htmlFor: id, title: t(control.help) }, t(control.label)),
      make("span", { className: "entry" }, this.entry, make("span", { className: "unit" }, control.unit)),
      this.slider,
      resetButton(t(control.label), () => events.reset()),
      this.fault,
    );
  }

  private makeSlider(id: string): HTMLInputElement {
    const { control } = this;
    const slider = make("input", { type: "range", id, title: t(control.help) });
    slider.min = String(sliderPosition(control, control.minimum));
    slider.max = String(sliderPosition(control, control.maximum));
    slider.step = String(control.step);
    slider.oninput = () => {
      const value = sliderValue(control, slider.valueAsNumber);
      this.write(value);
      this.events.set(value);
    };
    slider.onpointerdown = () => (this.dragging = true);
    slider.onpointerup = slider.onpointercancel = slider.onblur = () => (this.dragging = false);
    return slider;
  }

  /** Shows the session's value unless the user is editing this row. */
  show(value: number): void {
    if (this.dragging || document.activeElement === this.entry) return;
    this.slider.value = String(sliderPosition(this.control, value));
    this.write(value);
  }

  private write(value: number): void {
    this.entry.value = formatNumber(value);
    const unit = this.control.unit ? ` ${this.control.unit}` : "";
    this.slider.setAttribute("aria-valuetext", decimal(formatNumber(value)) + unit);
    this.slider.style.setProperty("--filled", `${(100 * this.filled(value)).toFixed(1)}%`);
    this.showError(undefined);
  }

  private filled(value: number): number {
    const [low, high] = [this.control.minimum, this.control.maximum].map((end) => sliderPosition(this.control, end));
    return (sliderPosition(this.control, value) - low) / (high - low);
  }

  private onEntry(): void {
    const value = this.entry.valueAsNumber;
    const fault = rangeError(this.control, value);
    this.showError(fault);
    if (fault !== undefined) return;
    this.slider.value = String(sliderPosition(this.control, value));
    this.write(value);
    this.events.set(value);
  }

  private showError(fault: string | undefined): void {
    this.fault.textContent = fault ?? "";
    this.entry.setAttribute("aria-invalid", String(fault !== undefined));
  }
}
