import { expect, test } from "vitest";
import { ColorScale } from "../../../../web/src/appearance/color_scale";
import { Legend } from "../../../../web/src/panels/view/legend";

test("TheLegendShowsRangeAndUnit", () => {
  const legend = new Legend();
  legend.show(new ColorScale(12));
  expect(legend.element.querySelector("canvas")!.ariaLabel).toBe("Colours from 0 to 12 mm");
  expect(legend.element.textContent).toMatch(/^mm0.*12$/);
});
