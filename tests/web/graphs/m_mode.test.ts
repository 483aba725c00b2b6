import { describe, expect, test } from "vitest";
import { crossings, summitOf } from "../../../web/src/geometry/column";
import { brightness, ColumnRecord, paint, pictureDepth, restDepth } from "../../../web/src/graphs/m_mode";

/** Two sloping squares over [-1, 1] x [-1, 1], z = x / 2 + `height` each. */
function sheets(...heights: number[]) {
  const corners = [-1, -1, 1, -1, 1, 1, -1, 1];
  const positions = heights.flatMap((height) =>
    [0, 1, 2, 3].flatMap((i) => [corners[2 * i], corners[2 * i + 1], corners[2 * i] / 2 + height]),
  );
  const triangles = heights.flatMap((_, k) => [0, 1, 2, 0, 2, 3].map((i) => 4 * k + i));
  return { positions: Float32Array.from(positions), triangles: Uint32Array.from(triangles) };
}

describe("a column", () => {
  test("CrossesEachSheetOnceAtItsHeight", () => {
    for (const [x, y] of [
      [0.3, 0.2],
      [-0.7, 0.1],
      [0.9, -0.95],
    ])
      // prettier-ignore
      expect(crossings(sheets(2, 1), x, y).map((z) => Number(z.toFixed(5)))).toEqual([1 + x / 2, 2 + x / 2]);
  });

  test("ThroughAnEdgeCrossesOnce", () => expect(crossings(sheets(1), 0.5, 0.5)).toHaveLength(1));

  test("BesideTheSurfaceCrossesNothing", () => expect(crossings(sheets(1), 1.5, 0)).toEqual([]));

  test("PassesThroughTheHighestVertexOfItsSide", () => {
    const positions = Float32Array.from([-1, 0, 5, -2, 0, 7, 1, 0, 9, 2, 0, 3]);
    expect([summitOf(positions, -1), summitOf(positions, 1)]).toEqual([1, 2]);
    expect(summitOf(Float32Array.from([1, 0, 0]), -1)).toBe(-1);
  });
});

describe("a record", () => {
  const record = new ColumnRecord(0.2, 10);
  record.add(0, [0.2, 0.203]);
  record.add(0.2, [0.19, 0.193]);

  test("HasDepthsFromTheProbeToWhichADescentComesNearer", () => {
    expect(record.depthsAt(0)![0]).toBeCloseTo(restDepth, 9);
    expect(record.depthsAt(0.2)![0]).toBeCloseTo(restDepth - 0.01, 9);
  });

  test("InterpolatesBetweenSamplesAndKnowsNothingOutside", () => {
    expect(record.depthsAt(0.1)![1]).toBeCloseTo(restDepth - 0.002, 9);
    expect([record.depthsAt(-0.1), record.depthsAt(0.3)]).toEqual([undefined, undefined]);
  });

  test("DoesNotBridgeAGapAndStartsAgainIfTimeGoesBack", () => {
    const other = new ColumnRecord(0, 10);
    other.add(1, [0]);
    other.add(3, [0]);
    expect(other.depthsAt(2)).toBeUndefined();
    other.add(0.5, [0.01]);
    expect(other.depthsAt(1)).toBeUndefined();
    expect(other.depthsAt(0.5)![0]).toBeCloseTo(restDepth + 0.01, 9);
  });

  test("ForgetsWhatIsOlderThanItsSpan", () => {
    const other = new ColumnRecord(0, 2);
    for (const time of [0, 0.4, 0.8, 1.2, 1.6, 2, 2.4]) other.add(time, [0]);
    expect(other.depthsAt(0.2)).toBeUndefined();
    expect(other.depthsAt(1)).toBeDefined();
  });
});

describe("the picture", () => {
  test("IsBrightestOnTheDiaphragmAndDarkestFarBeyondIt", () => {
    const at = (depth: number) => brightness(depth, [0.08, 0.084]);
    expect(Math.min(at(0.08), at(0.084))).toBeGreaterThanOrEqual(1);
    for (let depth = 0; depth < 0.075; depth += 0.0007) expect(at(depth)).toBeLessThan(0.5);
    expect(at(0.139)).toBeLessThan(0.02);
  });

  test("FollowsTheDomeOverTime", () => {
    const record = new ColumnRecord(0, 10);
    const descent = (time: number) => 0.02 * time;
    for (let time = 0; time <= 2; time += 0.1) record.add(time, [-descent(time)]);
    const [width, height] = [40, 140];
    const pixels = new Uint8ClampedArray(4 * width * height);
    paint(pixels, width, record, { start: 0, end: 4 });
    const levels = (column: number) => Array.from({ length: height }, (_, row) => pixels[4 * (row * width + column)]);
    for (const column of [2, 10, 18]) {
      const time = ((column + 0.5) / width) * 4;
      const brightest = levels(column).indexOf(Math.max(...levels(column)));
      expect(((brightest + 0.5) / height) * pictureDepth).toBeCloseTo(restDepth - descent(time), 2.5);
    }
    expect(Math.max(...levels(30))).toBe(0);
  });
});
