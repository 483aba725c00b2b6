import { create } from "@bufbuild/protobuf";
import { describe, expect, test } from "vitest";
import { SessionReferences } from "../../../web/src/app/session_references";
import { FrameSchema } from "../../../web/src/gen/phrenic/v1/frames_pb";
import {
  HealthRange_Change,
  HealthRangeSchema,
  StaticCurve_Kind,
  StaticCurveSchema,
} from "../../../web/src/gen/phrenic/v1/references_pb";
import type { Preset } from "../../../web/src/gen/phrenic/v1/scene_pb";
import { SessionSchema } from "../../../web/src/gen/phrenic/v1/session_pb";
import { campbellGraph } from "../../../web/src/graphs/catalogue";
import { backdropOf, pressureAt, workOfBreathing } from "../../../web/src/graphs/references";
import { SteadyRange } from "../../../web/src/graphs/window";
import { SessionController } from "../../../web/src/session/session_controller";
import { Signal } from "../../../web/src/state/signal";
import { FakeClock, settle } from "../fakes/fake_clock";
import { FakeServer } from "../fakes/fake_server";

const range = (breath: string, change: HealthRange_Change, low: number, high: number) =>
  create(HealthRangeSchema, { breath, measure: "lung volume", change, low, high });
const ranges = [
  range("quiet", HealthRange_Change.RISE, 0.0004, 0.0007),
  range("deep", HealthRange_Change.RISE, 0.0023, 0.0038),
];
const volume = {
  id: "volume",
  title: "Volume",
  unit: "l",
  curves: [{ key: "measure lung volume", name: "lung volume", factor: 1000 }],
};
const dataOf = (...values: number[]) => ({ times: values.map((_, i) => i), abscissa: undefined, curves: [values] });
const references = { ranges, curves: [], breath: "quiet", period: 4 };

describe("a range of health", () => {
  test("LiesAboveTheSmallestValueForARise", () => {
    const [band] = backdropOf(volume, dataOf(2.5, 2.9, 2.4), references)!.bands;
    expect(band.low).toBeCloseTo(2.8);
    expect(band.high).toBeCloseTo(3.1);
  });

  test("IsThatOfTheChosenBreathOrElseOfAQuietOne", () => {
    const lowOf = (breath: string) => backdropOf(volume, dataOf(2), { ...references, breath })!.bands[0].low;
    expect(lowOf("deep")).toBeCloseTo(4.3);
    expect(lowOf("paralysis-right")).toBeCloseTo(2.4);
  });

  test("LiesBelowTheLargestValueForAFallAndTurnsWithTheSignOfTheGraph", () => {
    const falls = { ...references, ranges: [range("quiet", HealthRange_Change.FALL, 0.01, 0.025)] };
    const heights = (factor: number) => ({ ...volume, unit: "mm", curves: [{ ...volume.curves[0], factor }] });
    const [up] = backdropOf(heights(1000), dataOf(1, -12), falls)!.bands;
    expect([up.low, up.high]).toEqual([-24, -9]);
    const [down] = backdropOf(heights(-1000), dataOf(-1, 12), falls)!.bands;
    expect([down.low, down.high]).toEqual([9, 24]);
  });

  test("IsAbsentForOtherMeasuresAndWithoutData", () => {
    expect(
      backdropOf({ ...volume, curves: [{ ...volume.curves[0], key: "measure flow" }] }, dataOf(1), references),
    ).toBe(undefined);
    expect(backdropOf(volume, dataOf(), references)).toBe(undefined);
  });
});

describe("a Campbell diagram", () => {
  // Lungs and wall of constant compliance, in l and kPa; the breath goes along an ellipse.
  const curve = (kind: StaticCurve_Kind, slope: number) =>
    create(StaticCurveSchema, {
      kind,
      volumes: [0.001, 0.005],
      pressures: [-500 + slope * -0.001, -500 + slope * 0.003],
    });
  const [lung, wall] = [curve(StaticCurve_Kind.LUNG_RECOIL, -5e5), curve(StaticCurve_Kind.CHEST_WALL, 4e5)];
  const frame = create(FrameSchema, {
    measures: [
      { name: "lung volume", unit: "m^3" },
      { name: "pleural pressure", unit: "Pa" },
    ],
  });

  test("InterpolatesItsCurves", () => {
    expect(pressureAt(lung, 0.002)).toBeCloseTo(-500);
    expect(pressureAt(wall, 0.003)).toBeCloseTo(-100);
    expect(pressureAt(wall, 0.009)).toBeCloseTo(700);
  });

  test("HasTheWorkOfItsAreas", () => {
    // From 2.0 to 2.5 l and back, 150 Pa below the recoil on the way up.
    const volumes = [...Array(101).keys()].map((i) => 0.002 + 5e-6 * (i <= 50 ? 2 * i : 2 * (100 - i)));
    const pressures = volumes.map((each, i) => pressureAt(lung, each) - (i <= 50 ? 150 : 0));
    const work = workOfBreathing(volumes, pressures, lung, wall);
    expect(work.elastic).toBeCloseTo((9e5 * 0.0005 ** 2) / 2, 4);
    expect(work.resistive).toBeCloseTo(150 * 0.0005, 2);
  });

  test("ShadesOnlyWhatTheLastBreathDid", () => {
    const spec = campbellGraph(frame)[0];
    const data = { times: [0, 1, 2, 3, 4], abscissa: [-9, -5, -6, -7, -5], curves: [[9, 2, 2.2, 2.5, 2]] };
    const { areas, lines, words } = backdropOf(spec, data, { ...references, curves: [lung, wall], period: 3 })!;
    expect(areas.length).toBe(2);
    expect(lines.map(({ dashed }) => dashed)).toEqual([false, true]);
    expect(Math.max(...areas.flatMap(({ points }) => points.map(([, y]) => y)))).toBeCloseTo(2.5);
    expect(words).toContain("Work of a breath");
  });

  test("IsAbsentWithoutLungsOrCurves", () => {
    expect(campbellGraph(create(FrameSchema, {}))).toEqual([]);
    expect(backdropOf(campbellGraph(frame)[0], dataOf(1), references)).toBe(undefined);
  });
});

describe("a steady axis", () => {
  test("StaysWhileTheValuesFitAndEndsAtRoundNumbers", () => {
    const axis = new SteadyRange();
    const first = axis.of([[2.43, 2.93]], 0.01);
    expect(first.map((each) => Number(each.toFixed(6)))).toEqual([2.4, 3]);
    expect(axis.of([[2.5, 2.9]], 0.01)).toEqual(first);
    expect(axis.of([[2.43, 2.981]], 0.01)).toEqual(first);
    const larger = axis.of([[2.43, 3.4]], 0.01);
    expect(larger[1]).toBeGreaterThanOrEqual(3.4);
    expect(larger).not.toEqual(first);
  });

  test("IsFittedAgainToMuchSmallerValues", () => {
    const axis = new SteadyRange();
    const large = axis.of([[0, 10]], 0.01);
    expect(axis.of([[4, 9]], 0.01)).toEqual(large);
    const [low, high] = axis.of([[4, 6]], 0.01);
    expect(high - low).toBeLessThan(5);
  });

  test("HasAWidthWithoutData", () => {
    expect(new SteadyRange().of([[]], 1)).toEqual([-1, 1]);
    const [low, high] = new SteadyRange().of([[5, 5]], 1);
    expect(high - low).toBeGreaterThanOrEqual(1);
  });
});

test("ReferencesThatAreRefusedAreReadAgainAfterAPause", async () => {
  const [server, clock] = [new FakeServer(), new FakeClock()];
  server.refusal = "not now";
  const controller = new SessionController(server.api, "thorax", clock);
  let changes = 0;
  new SessionReferences(server.api, controller, new Signal<Preset[]>([]), () => changes++, clock).start();
  const state = async () => {
    controller.receive(create(SessionSchema, { parameters: {} }));
    await settle();
  };
  for (let i = 0; i < 10; i++) await state();
  expect(server.referenceReads).toBe(1);
  server.refusal = "";
  await clock.advance(15_000);
  for (let i = 0; i < 10; i++) await state();
  expect([server.referenceReads, changes]).toEqual([2, 1]);
});
