import type { NumberControl } from "./controls";
import { decimal, t } from "../language/translate";

/** Returns the slider position of `value`. */
export function sliderPosition(control: NumberControl, value: number): number {
  return control.logarithmic ? Math.log10(value) : value;
}

/** Returns the value of a slider position, rounded to the slider's resolution and limited to the range. */
export function sliderValue(control: NumberControl, position: number): number {
  const raw = control.logarithmic ? 10 ** position : position;
  const value = control.logarithmic ? Number(raw.toPrecision(3)) : Number(raw.toFixed(decimalsOf(control.step)));
  return Math.min(control.maximum, Math.max(control.minimum, value));
}

function decimalsOf(step: number): number {
  return Math.max(0, Math.min(12, Math.ceil(-Math.log10(step) - 1e-9) + 1));
}

/** Returns an error message if `value` is out of range; otherwise undefined. */
export function rangeError(control: NumberControl, value: number): string | undefined {
  if (Number.isFinite(value) && value >= control.minimum && value <= control.maximum) return undefined;
  const unit = control.unit ? ` ${control.unit}` : "";
  const [low, high] = [control.minimum, control.maximum].map((each) => decimal(formatNumber(each)));
  return t("{0} must be between {1} and {2}.", t(control.label), low, high + unit);
}

/** Formats at most four significant digits, without trailing zeros. */
export function formatNumber(value: number): string {
  return String(Number(value.toPrecision(4)));
}
