import { expect, test } from "vitest";
import { breathMotion } from "../../../web/src/graphs/breath_motion";
import { motionWords } from "../../../web/src/graphs/motion_words";
import { besideGraph, joinSeries } from "../../../web/src/graphs/student_graphs";
import { TimeSeries } from "../../../web/src/state/time_series";

const keys = { volume: "v", domes: [{ key: "r", name: "right dome" }, { key: "l", name: "left dome" }] }; // prettier-ignore

/** A breath of half a litre; the right dome rises by 7 mm while the left falls by 16. */
function breathing(step: number, end: number): TimeSeries {
  const history = new TimeSeries(60);
  for (let time = 0; time <= end + 1e-9; time += step) {
    const part = (1 - Math.cos((2 * Math.PI * time) / 4)) / 2;
    history.add(time, [["v", 0.0025 + 0.0005 * part], ["r", 0.007 * part], ["l", -0.016 * part]]); // prettier-ignore
  }
  return history;
}

test("ABreathIsReadFromItsEmptiestToItsFullestMoment", () => {
  const motion = breathMotion(breathing(0.05, 9), keys, 4, 0)!;
  expect(motion.tidalVolume).toBeCloseTo(0.0005, 9);
  expect(motion.domes.map(({ change }) => change)).toEqual([expect.closeTo(0.007, 6), expect.closeTo(-0.016, 6)]);
});

test("ABreathThatIsNotWholeIsNotTold", () => {
  expect(breathMotion(breathing(0.05, 3.9), keys, 4, 0)).toBeUndefined();
  expect(breathMotion(breathing(0.05, 9), keys, 4, 5.5)).toBeUndefined();
  expect(breathMotion(breathing(0.9, 9), keys, 4, 0)).toBeUndefined();
  expect(breathMotion(new TimeSeries(60), keys, 4, 0)).toBeUndefined();
});

const motion = (litres: number, right: number, left: number) => ({
  tidalVolume: litres / 1000,
  domes: [{ name: "right dome", change: right / 1000 }, { name: "left dome", change: left / 1000 }], // prettier-ignore
});

test("DomesThatMoveAgainstEachOtherAreParadoxical", () => {
  expect(motionWords(motion(0.39, 7, -16))).toBe(
    "The right dome rises by 7 mm while the left falls by 16 mm: paradoxical motion. A breath brings 0.39 l of air.",
  );
});

test("AHealthyBreathIsNotParadoxical", () => {
  const words = motionWords(motion(0.5, -13, -7));
  expect(words).toBe("Both domes fall, the right by 13 mm and the left by 7. A breath brings 0.50 l of air.");
});

test("AComparisonNamesBothVolumes", () => {
  const words = motionWords(motion(0.39, 0.2, -16), { label: "second view", motion: motion(0.5, -13, -7) });
  expect(words).toBe(
    "The right dome hardly moves while the left falls by 16 mm. A breath brings 0.39 l of air instead of 0.50. " +
      "Second view: both domes fall, the right by 13 mm and the left by 7.",
  );
});

test("AnotherBreathWithoutAirIsNotNamed", () => {
  const other = { label: "Quiet, supine", motion: motion(0.001, -3, -2) };
  expect(motionWords(motion(0.39, 0.2, -16), other)).not.toContain("Quiet");
});

test("WithoutAirNothingIsSaidOfTheDomes", () => {
  expect(motionWords(motion(0.001, -3, -2))).toBe("No air moves.");
});

test("TwoSessionsAreJoinedAtTheTimesOfTheFirst", () => {
  const [here, beside, joined] = [new TimeSeries(60), new TimeSeries(60), new TimeSeries(60)];
  for (const time of [0, 1, 2, 3]) here.add(time, [["v", time]]);
  for (const time of [0.5, 2.5]) beside.add(time, [["v", 10 * time]]);
  joinSeries(joined, here, beside, 12);
  expect(joined.times).toEqual([1, 2]);
  expect(joined.series.get("v")).toEqual([1, 2]);
  expect(joined.series.get("beside v")).toEqual([10, 20]);
});

test("TheSecondSessionHasADashedCurveOfTheSameColour", () => {
  const curves = [{ key: "r", name: "right dome", factor: 1000 }, { key: "l", name: "left dome", factor: 1000 }]; // prettier-ignore
  const spec = besideGraph({ id: "domes", title: "Domes", unit: "mm", curves }, "chosen", "healthy");
  expect(spec.curves.map(({ name, order, dashed }) => [name, order, dashed])).toEqual([
    ["right dome, chosen", 0, undefined],
    ["left dome, chosen", 1, undefined],
    ["right dome, healthy", 0, true],
    ["left dome, healthy", 1, true],
  ]);
});
