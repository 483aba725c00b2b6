import { expect, test } from "vitest";
import type { KeptMeasurement } from "../../../web/src/geometry/measuring";
import { measurementsOf, withMeasurements } from "../../../web/src/session/measured_links";

const kept: KeptMeasurement[] = [
  { tool: "distance", points: [{ body: "rib-5-left", rest: [0.0123, -0.04, 0.25] }, { body: "rib-6-left", rest: [0, 0, 0] }] }, // prettier-ignore
  { tool: "angle", points: ["a:b,c", "ä %", "x"].map((body) => ({ body, rest: [0.1, 0.2, -0.3] as const })) },
  { tool: "body", points: [{ body: "liver", rest: [-0.05, 0.01, 0.15] }] },
];
const open = (query: string) => measurementsOf(new URL(`http://localhost/${query}`));

test("ALinkKeepsMeasurementsToAHundredthOfAMillimetre", () => {
  const read = open(withMeasurements("?session=s", kept));
  expect(read.map(({ tool, points }) => [tool, points.map(({ body }) => body)])).toEqual(
    kept.map(({ tool, points }) => [tool, points.map(({ body }) => body)]),
  );
  kept.forEach(({ points }, i) =>
    points.forEach(({ rest }, k) =>
      rest.forEach((value, axis) => expect(read[i].points[k].rest[axis]).toBeCloseTo(value, 5)),
    ),
  );
});

test("ALinkWithoutMeasurementsIsUnchangedAndMeasuresNothing", () => {
  expect(withMeasurements("?session=s", [])).toBe("?session=s");
  expect(withMeasurements(withMeasurements("?session=s", kept), [])).toBe("?session=s");
  expect(open("?session=s")).toEqual([]);
});

test.each([
  ["length:a,1,2,3:b,1,2,3", 'measure[0].tool: "length" is not one of distance, angle, surface, body'],
  ["distance:a,1,2,3", 'measure[0].points: "distance" needs 2, not 1'],
  ["surface:a,1,2", "measure[0].points[0].rest: give the three numbers of a place"],
  ["surface:a,1,,3", "measure[0].points[0].rest: give the three numbers of a place"],
  ["surface:a,1,x,3", "measure[0].points[0].rest: give the three numbers of a place"],
])("AMistakeInALinkIsNamed %s", (text, message) => {
  expect(() => open(`?${new URLSearchParams({ measure: text })}`)).toThrow(message);
});

test("ALinkHasAtMostTwelveMeasurements", () => {
  const many = new URLSearchParams(Array.from({ length: 13 }, () => ["measure", "body:a,1,2,3"]));
  expect(() => open(`?${many}`)).toThrow("measure: give at most 12 measurements");
});
