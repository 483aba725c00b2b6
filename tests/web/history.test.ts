import { expect, test } from "vitest";
import { History } from "../../web/src/history";

test("OnlyTheLastSecondsAreKept", () => {
  const history = new History(2);
  for (let time = 0; time <= 10; time++) history.add(time, [["dome", -time]]);
  expect(history.times).toEqual([8, 9, 10]);
  expect(history.series.get("dome")).toEqual([-8, -9, -10]);
  expect(history.range()).toEqual([-10, -8]);
});

test("TimeThatGoesBackStartsAfresh", () => {
  const history = new History(10);
  history.add(5, [["dome", 1]]);
  history.add(0, [["dome", 2]]);
  expect(history.series.get("dome")).toEqual([2]);
});

test("OtherProbesStartAfresh", () => {
  const history = new History(10);
  history.add(1, [["dome", 1]]);
  history.add(2, [["mass", 2]]);
  expect([...history.series.keys()]).toEqual(["mass"]);
});

test("AFrameThatIsSentTwiceCountsOnce", () => {
  const history = new History(10);
  history.add(1, [["dome", 1]]);
  history.add(1, [["dome", 1]]);
  expect(history.times).toEqual([1]);
});
