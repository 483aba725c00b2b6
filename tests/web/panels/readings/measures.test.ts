import { create } from "@bufbuild/protobuf";
import { expect, test } from "vitest";
import { FrameSchema } from "../../../../web/src/gen/phrenic/v1/frames_pb";
import { Measures, readingText } from "../../../../web/src/panels/readings/measures";

test("ReadingsAreInTheUnitsOfTheInterface", () => {
  expect(readingText(0.00251349, "m^3")).toBe("2.513 l");
  expect(readingText(-0.0004, "m^3/s")).toBe("-0.4 l/s");
  expect(readingText(0.0123, "m")).toBe("12.3 mm");
  expect(readingText(-530, "Pa")).toBe("-530 Pa");
});

test("TheListFollowsTheFrameAndIsHiddenWithoutMeasures", () => {
  const panel = new Measures();
  const frame = (...readings: { name: string; value: number; unit: string }[]) =>
    create(FrameSchema, { measures: readings });
  panel.show(
    frame({ name: "flow", value: 0.001, unit: "m^3/s" }, { name: "pleural pressure", value: -500, unit: "Pa" }),
  );
  expect(panel.element.hidden).toBe(false);
  expect([...panel.element.querySelectorAll("tr")].map((row) => row.textContent)).toEqual([
    "flow1 l/s",
    "pleural pressure-500 Pa",
  ]);
  panel.show(frame({ name: "flow", value: 0.002, unit: "m^3/s" }));
  expect(panel.element.querySelectorAll("tr")).toHaveLength(1);
  expect(panel.element.textContent).toContain("2 l/s");
  panel.show(frame());
  expect(panel.element.hidden).toBe(true);
});
