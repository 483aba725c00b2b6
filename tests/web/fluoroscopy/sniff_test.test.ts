import { expect, test } from "vitest";
import { SniffTest, sniffWords } from "../../../web/src/fluoroscopy/sniff_test";

/**
 * Passes breaths of 6 s to a test: a sniff of 0.5 s at each multiple, with these excursions [m]. Returns when it ended.
 */
function sniff(right: number, left: number, from = 2.5): { test: SniffTest; end: number | undefined } {
  const test = new SniffTest();
  let end: number | undefined;
  for (let time = from; time < 20; time += 0.03) {
    const since = time % 6;
    const breath = since < 0.5 ? Math.sin((Math.PI * since) / 0.5) : 0;
    const drift = 0.002 * Math.sin(time / 3);
    if (test.receive({ time, breath, right: drift + right * breath, left: drift + left * breath })) end ??= time;
  }
  return { test, end };
}

test("ASniffIsMeasuredFromItsOnsetOnEachSide", () => {
  const { test: done, end } = sniff(-0.03, 0.008);
  expect(end).toBeLessThan(7);
  expect(end).toBeGreaterThan(6.4);
  expect(done.result?.onset).toBeCloseTo(18, 1);
  expect(done.result?.sniffs).toBe(3);
  expect(done.result?.gap).toBeCloseTo(0.03, 6);
  expect(done.result?.right).toBeCloseTo(-0.03, 3);
  expect(done.result?.left).toBeCloseTo(0.008, 3);
});

test("TheSniffInWhichTheTestBeginsDoesNotCount", () => {
  expect(sniff(-0.03, -0.03, 6.2).test.result?.sniffs).toBe(2);
});

test("ARestartedRunStartsTheTestAgain", () => {
  const { test: done } = sniff(-0.03, -0.03);
  expect(done.receive({ time: 0, breath: 0, right: 0, left: 0 })).toBe(false);
  expect(done.result).toBeUndefined();
  expect(done.heights.length).toBe(1);
});

test("FramesOfASlowMachineCountTheMostOfSeveralSniffs", () => {
  const slow = new SniffTest();
  const moments = [4, 5.9, 6.1, 6.3, 8, 11.9, 12.25, 12.4, 14, 17.9, 18.1, 18.2, 19];
  for (const time of moments) {
    const breath = time % 6 < 0.5 ? Math.sin((Math.PI * (time % 6)) / 0.5) : 0;
    slow.receive({ time, breath, right: 0.02 * breath, left: -0.03 * breath });
  }
  expect(slow.result?.right).toBeCloseTo(0.02, 6);
  expect(sniffWords(slow.result!)).toContain("the most of 3 sniffs");
  expect(sniffWords(slow.result!)).toMatch(/Frames are \d\.\d\d s apart here/);
});

const wordsOf = (moved: { right: number; left: number }) => sniffWords({ ...moved, sniffs: 1, gap: 0.02 });

test("TheWordsFollowTheNumbers", () => {
  expect(wordsOf({ right: -0.0312, left: -0.0268 })).toMatch(/^Right dome 31 mm down, left dome 27 mm down\. Both domes fall, as in health/); // prettier-ignore
  const palsy = wordsOf({ right: 0.0081, left: -0.03 });
  expect(palsy).toContain("Right dome 8 mm up, left dome 30 mm down.");
  expect(palsy).toContain("The right dome rises while the left dome falls: paradoxical");
  expect(palsy).toContain("Below 20 mm");
  expect(wordsOf({ right: 0.025, left: -0.03 })).not.toContain("Below 20 mm");
  expect(wordsOf({ right: 0.01, left: 0.012 })).toContain("Both domes rise: paradoxical on both sides.");
  expect(wordsOf({ right: -0.03, left: -0.012 })).toContain("The left dome falls by less than 16 mm");
  expect(wordsOf({ right: -0.001, left: 0.0001 })).toContain("reduced, not paradoxical");
});
