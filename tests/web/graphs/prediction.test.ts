import { expect, test } from "vitest";
import { Prediction } from "../../../web/src/graphs/prediction";
import { TimeSeries } from "../../../web/src/state/time_series";

const breath = (value: (time: number) => number) => {
  const history = new TimeSeries(60);
  for (let time = 0; time <= 20; time += 0.25) history.add(time, [["v", value(time)]]);
  return history;
};

test("APredictionIsFlatUntilItIsDrawn", () => {
  const flat = new Prediction(10, 4, 2.5);
  expect(flat.distance(breath(() => 2.5), "v")).toBeCloseTo(0, 12); // prettier-ignore
  expect(flat.distance(breath(() => 3), "v")).toBeCloseTo(0.5, 12); // prettier-ignore
});

test("ALineThatFollowsTheBreathHasNoDistance", () => {
  const drawn = new Prediction(10, 4, 2.5);
  drawn.line({ point: drawn.pointAt(0), value: 2.5 }, { point: drawn.pointAt(1), value: 3.5 });
  expect(drawn.distance(breath((time) => 2.5 + (time - 10) / 4), "v")).toBeCloseTo(0, 9); // prettier-ignore
  expect(drawn.distance(breath(() => 2.5), "v")).toBeCloseTo(0.5, 9); // prettier-ignore
});

test("TheKnownFirstValueIsNotDrawnOver", () => {
  const drawn = new Prediction(10, 4, 2.5);
  drawn.line({ point: 5, value: 9 }, { point: 0, value: 9 });
  expect(drawn.values.slice(0, 3)).toEqual([2.5, 9, 9]);
});

test("ACurveIsStretchedOverALongerBreath", () => {
  const drawn = new Prediction(10, 4, 2.5);
  drawn.line({ point: 0, value: 2.5 }, { point: 40, value: 3.5 });
  const longer = drawn.over(8);
  expect([longer.start, longer.end, longer.values]).toEqual([10, 18, drawn.values]);
  expect(longer.distance(breath((time) => 2.5 + (time - 10) / 8), "v")).toBeCloseTo(0, 9); // prettier-ignore
});

test("PartsOutsideTheSpanAreItsEnds", () => {
  const { values, timeOf } = new Prediction(10, 4, 2.5);
  const prediction = new Prediction(10, 4, 2.5);
  expect([prediction.pointAt(-1), prediction.pointAt(2)]).toEqual([0, values.length - 1]);
  expect(timeOf.call(prediction, values.length - 1)).toBe(14);
});
