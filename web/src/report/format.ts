const raised = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** Formats "10⁻³". */
export function powerOfTen(exponent: number): string {
  const digits = [...String(Math.abs(exponent))].map((digit) => raised[Number(digit)]).join("");
  return `10${exponent < 0 ? "⁻" : ""}${digits}`;
}

/** Formats at most `digits` significant digits: "0.01234", "1.5 × 10⁻⁷". */
export function formatDigits(value: number, digits = 4): string {
  if (Number.isNaN(value)) return "not a number";
  if (!Number.isFinite(value)) return value < 0 ? "−∞" : "∞";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) {
    const [mantissa, exponent] = size.toExponential(digits - 1).split("e");
    const factor = String(Number(mantissa));
    return `${value < 0 ? "−" : ""}${factor} × ${powerOfTen(Number(exponent))}`;
  }
  return grouped(Number(value.toPrecision(digits)));
}

/** Separates thousands by a narrow no-break space: "12 400". */
function grouped(value: number): string {
  const [whole, part] = String(Math.abs(value)).split(".");
  const apart = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, "\u202f") : whole;
  return `${value < 0 ? "−" : ""}${apart}${part === undefined ? "" : `.${part}`}`;
}

/** Formats ticks of a logarithmic axis: plain numbers if all are short, otherwise powers like "10⁻⁵". */
export function formatTicks(ticks: number[]): (value: number) => string {
  const plain = ticks.every((tick) => tick > 0.999e-3 && tick < 1.001e5);
  return (value) => formatTick(value, plain ? [-3, 5] : [-1, 1]);
}

function formatTick(value: number, [least, most]: [number, number]): string {
  const exponent = Math.floor(Math.log10(value) + 1e-9);
  if (exponent >= least && exponent <= most) return formatDigits(value, 3);
  const factor = Math.round(value / 10 ** exponent);
  return factor === 1 ? powerOfTen(exponent) : `${factor}·${powerOfTen(exponent)}`;
}

/** Formats "1 run", "3 runs". */
export function count(number: number, what: string): string {
  return `${number} ${what}${number === 1 ? "" : "s"}`;
}
