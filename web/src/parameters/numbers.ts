import type { NumberControl } from "./controls";

/** Where the slider stands for `value`. */
export function sliderPosition(control: NumberControl, value: number): number {
  return control.logarithmic ? Math.log10(value) : value;
}

/** The value for a slider's position, rounded to what the slider can tell apart, inside the range. */
export function sliderValue(control: NumberControl, position: number): number {
  const raw = control.logarithmic ? 10 ** position : position;
  const value = control.logarithmic ? Number(raw.toPrecision(3)) : Number(raw.toFixed(decimalsOf(control.step)));
  return Math.min(control.maximum, Math.max(control.minimum, value));
}

function decimalsOf(step: number): number {
  return Math.max(0, Math.min(12, Math.ceil(-Math.log10(step) - 1e-9) + 1));
}

/** Why `value` may not be sent, or nothing. */
export function rangeError(control: NumberControl, value: number): string | undefined {
  if (Number.isFinite(value) && value >= control.minimum && value <= control.maximum) return undefined;
  return `${control.label} goes from ${formatNumber(control.minimum)} to ${formatNumber(control.maximum)}${
    control.unit ? " " + control.unit : ""
  }.`;
}

/** At most four significant digits, without trailing zeros. */
export function formatNumber(value: number): string {
  return String(Number(value.toPrecision(4)));
}
