import { expect, test } from "vitest";
import { TimeSeries } from "../../../web/src/state/time_series";

test("ValuesBeyondTheSpanAreDropped", () => {
  const history = new TimeSeries(2);
  for (let time = 0; time <= 10; time++) history.add(time, [["dome", -time]]);
  expect(history.times).toEqual([8, 9, 10]);
  expect(history.series.get("dome")).toEqual([-8, -9, -10]);
});

test("IndexAtFindsATime", () => {
  const history = new TimeSeries(20);
  for (let time = 0; time <= 10; time += 2) history.add(time, [["dome", -time]]);
  expect([-1, 0, 1, 4, 9.9, 11].map((time) => history.indexAt(time))).toEqual([0, 0, 1, 2, 5, 6]);
});

test("TimeThatGoesBackRestarts", () => {
  const history = new TimeSeries(10);
  history.add(5, [["dome", 1]]);
  history.add(0, [["dome", 2]]);
  expect(history.series.get("dome")).toEqual([2]);
});

test("OtherNamesRestart", () => {
  const history = new TimeSeries(10);
  history.add(1, [["dome", 1]]);
  history.add(2, [["mass", 2]]);
  expect([...history.series.keys()]).toEqual(["mass"]);
});

test("ARepeatedTimeIsIgnored", () => {
  const history = new TimeSeries(10);
  history.add(1, [["dome", 1]]);
  history.add(1, [["dome", 1]]);
  expect(history.times).toEqual([1]);
});

test("ProvisionalValuesStayUntilTheNextOnes", () => {
  const history = new TimeSeries(10);
  history.add(0.5, [["v", 1]], true);
  expect(history.times).toEqual([0.5]);
  history.add(0.52, [["v", 2]]);
  history.add(0.54, [["v", 3]]);
  expect([history.times, history.series.get("v")]).toEqual([
    [0.52, 0.54],
    [2, 3],
  ]);
});

test("ProvisionalValuesAtTheTimeOfTheLastOnesRemoveNothing", () => {
  const history = new TimeSeries(10);
  history.add(0.5, [["v", 1]]);
  history.add(0.5, [["v", 1]], true);
  history.add(0.52, [["v", 2]]);
  expect(history.times).toEqual([0.5, 0.52]);
});
