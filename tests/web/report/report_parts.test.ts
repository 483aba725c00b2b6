import { create } from "@bufbuild/protobuf";
import { describe, expect, test } from "vitest";
import { CostRowSchema, ErrorRowSchema, StabilityRowSchema } from "../../../web/src/gen/phrenic/v1/study_results_pb";
import { logDomain, logTicks } from "../../../web/src/report/axes";
import { cellsOf, edgesOf } from "../../../web/src/report/cells";
import { guidesIn } from "../../../web/src/report/convergence";
import { placeLabels } from "../../../web/src/report/direct_labels";
import { formatDigits, formatTicks } from "../../../web/src/report/format";
import { headingOf } from "../../../web/src/report/headings";
import { seriesName, seriesStyles } from "../../../web/src/report/names";
import { tableOf } from "../../../web/src/report/table";

describe("numbers", () => {
  test.each([
    [0, "0"],
    [0.0123456, "0.01235"],
    [-1234.56, "−1235"],
    [123456, "123\u202f500"],
    [1.5e-7, "1.5 × 10⁻⁷"],
    [-2.0004e12, "−2 × 10¹²"],
    [Infinity, "∞"],
    [NaN, "not a number"],
  ])("%d is formatted as %s", (value, words) => expect(formatDigits(value)).toBe(words));

  test("TicksOfOneAxisHaveOneFormat", () => {
    expect([0.001, 0.1, 10].map(formatTicks([0.001, 0.1, 10]))).toEqual(["0.001", "0.1", "10"]);
    expect([1e-5, 1e-3, 0.1, 20_000].map(formatTicks([1e-5]))).toEqual(["10⁻⁵", "10⁻³", "0.1", "2·10⁴"]);
  });
});

describe("axes", () => {
  test("CoverThePositiveValues", () => {
    const [low, high] = logDomain([0.01, 5, Number.NaN, 0, -1]);
    expect(low).toBeLessThan(0.01);
    expect(low).toBeGreaterThan(0.001);
    expect(high).toBeGreaterThan(5);
    expect(logDomain([])).toEqual([0.1, 10]);
  });

  test("HaveRoomForASingleValue", () => {
    const [low, high] = logDomain([3]);
    expect(low).toBeLessThan(2.9);
    expect(high).toBeGreaterThan(3.1);
  });

  test("HaveBetweenTwoAndTwelveTicks", () => {
    for (const span of [0.5, 1, 2, 3, 6, 14]) {
      const ticks = logTicks([0.0123, 0.0123 * 10 ** span]);
      expect(ticks.length, String(span)).toBeGreaterThanOrEqual(2);
      expect(ticks.length, String(span)).toBeLessThanOrEqual(12);
    }
  });
});

test.each([
  ["error_rms_mm", "Error RMS [mm]"],
  ["time_step_s", "Time step [s]"],
  ["error_energy_j", "Error energy [J]"],
  ["cpu_us_per_step", "CPU [µs per step]"],
  ["ns_per_vertex_step", "Time [ns per vertex step]"],
  ["us_per_step", "Time [µs per step]"],
  ["steps_per_s", "Steps per s"],
  ["diverged_at_s", "Diverged at [s]"],
  ["over_never_had", "Over never had"],
])("the heading of the field %s is %s", (field, heading) => expect(headingOf(field)).toBe(heading));

describe("series styles", () => {
  test("SeriesHaveDifferentColoursAndSymbols", () => {
    const ids = ["thesis", "bdf2", "one", "two", "velocity_verlet"];
    const styles = [...seriesStyles(ids).values()];
    expect(new Set(styles.map(({ color }) => color)).size).toBe(ids.length);
    expect(new Set(styles.map(({ symbol }) => symbol)).size).toBe(ids.length);
    expect(seriesName("some_new_one")).toBe("Some new one");
  });
});

describe("tables", () => {
  const headings = (table: HTMLElement) => [...table.querySelectorAll("th")].map((each) => each.textContent);

  test("OmitEmptyColumnsAndKeepZeros", () => {
    const rows = [create(CostRowSchema, { variant: "full", vertices: 120_000n, timesThesis: 3 })];
    const table = tableOf("Cost", CostRowSchema, rows);
    expect(headings(table)).toContain("Times thesis");
    expect(headings(table)).not.toContain("Over never had");
    expect(headings(table)).not.toContain("Note");
    const cells = [...table.querySelectorAll("td")].map((each) => each.textContent);
    expect(cells.slice(0, 4)).toEqual(["full", "120\u202f000", "0", "0"]);
  });

  test("ShowUnsetValuesAsADash", () => {
    const rows = [create(ErrorRowSchema, { order: 0 }), create(ErrorRowSchema, { realTime: false })];
    const table = tableOf("Runs", ErrorRowSchema, rows);
    const column = headings(table).indexOf("Measured order");
    const cells = [...table.querySelectorAll("tbody tr")].map((row) => row.children[column].textContent);
    expect(cells).toEqual(["0", "–"]);
  });
});

describe("the map's cells", () => {
  test("MeetAtGeometricMeans", () => {
    expect(edgesOf([1, 4, 16])).toEqual([0.5, 2, 8, 32]);
    expect(edgesOf([2])[0]).toBeCloseTo(Math.SQRT2);
    expect(edgesOf([2])[1]).toBeCloseTo(2 * Math.SQRT2);
  });

  test("CoverEveryRunOnce", () => {
    const row = create(StabilityRowSchema);
    const points = [1, 10, 100].flatMap((y) => [4, 1, 2].map((x) => ({ x: x / y, y, row })));
    const cells = cellsOf(points);
    expect(cells.length).toBe(9);
    for (const { x, y, x1, x2, y1, y2 } of cells) expect(x1 < x && x < x2 && y1 < y && y < y2).toBe(true);
  });
});

test("GuidesHaveTheirSlopesWithinTheFrame", () => {
  for (const { order, points } of guidesIn(10, 1000, [0.01, 10])) {
    const [from, to] = points;
    expect(Math.log(to.y / from.y) / Math.log(to.x / from.x)).toBeCloseTo(order, 9);
    expect(to.x).toBeLessThanOrEqual(1000);
    expect(to.y).toBeLessThanOrEqual(10.001);
  }
});

test("LabelsOfMeetingCurvesDoNotOverlap", () => {
  const lines = [0, 1, 2, 3, 4].map((i) => ({
    name: `integrator ${i}`,
    points: [0, 1, 2].map((k) => ({ x: 200 + 100 * k, y: 300 - 60 * k + 4 * i })),
  }));
  const boxes = placeLabels(lines, [], { left: 0, top: 0, right: 700, bottom: 500 });
  boxes.forEach((a, i) =>
    boxes.slice(i + 1).forEach((b) => {
      expect(a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom).toBe(false);
    }),
  );
});
