import { describe, expect, test } from "vitest";
import { ColorScale, niceTop } from "../../../web/src/appearance/color_scale";

/** Returns the CIE 1976 lightness, 0 to 100, of an sRGB colour. */
function lightnessOf(rgb: [number, number, number]): number {
  const [r, g, b] = rgb.map((byte) => (byte > 10 ? ((byte / 255 + 0.055) / 1.055) ** 2.4 : byte / 255 / 12.92));
  const y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  return y > 0.008856 ? 116 * Math.cbrt(y) - 16 : 903.3 * y;
}

describe("the colour scale", () => {
  test("EndsAtARoundNumberAboveAllValues", () => {
    expect(niceTop([0.2, 11.3, NaN, 4])).toBe(12);
    expect(niceTop([0.0234])).toBe(0.025);
    expect(niceTop([7])).toBe(7);
  });

  test("HasAMinimumForEqualSurfaces", () => {
    expect(niceTop([])).toBe(0.001);
    expect(niceTop([1e-13, NaN])).toBe(0.001);
  });

  test("LightnessIsLinearInTheValue", () => {
    const scale = new ColorScale(10);
    const lightness = Array.from({ length: 11 }, (_, i) => lightnessOf(scale.color(i)));
    const steps = lightness.slice(1).map((l, i) => l - lightness[i]);
    const mean = (lightness[10] - lightness[0]) / 10;
    for (const step of steps) expect(Math.abs(step - mean)).toBeLessThan(0.2 * mean);
  });

  test("ClampsValuesAndShowsNaNInGrey", () => {
    const scale = new ColorScale(10);
    expect(scale.color(11)).toEqual(scale.color(10));
    expect(scale.color(-1)).toEqual(scale.color(0));
    const [red, green, blue] = scale.color(NaN);
    expect(Math.max(red, green, blue) - Math.min(red, green, blue)).toBeLessThan(20);
  });

  test("ReturnsThreeBytesPerVertex", () => {
    const scale = new ColorScale(10);
    expect([...scale.colors([0, 10])]).toEqual([...scale.color(0), ...scale.color(10)]);
  });

  test("HasTicksFromZeroToItsEnd", () => {
    const ticks = new ColorScale(12).ticks();
    expect(ticks[0]).toEqual({ fraction: 0, text: "0" });
    expect(ticks.at(-1)).toEqual({ fraction: 1, text: "12" });
    expect(new ColorScale(0.025).ticks().at(-1)).toEqual({ fraction: 1, text: "0.025" });
  });
});
