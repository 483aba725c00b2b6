import { expect, test } from "vitest";
import { Measurements, quantityText } from "../../../web/src/appearance/measurements";
import { Placement } from "../../../web/src/gen/phrenic/v1/frames_pb";
import { decodeBody } from "../../../web/src/geometry/bodies";
import { triangleBody } from "../fakes/fake_server";

const bytes = (values: Float32Array | Uint32Array) => new Uint8Array(values.buffer);
const corners = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]);
const faces = new Uint32Array([0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]);
const tetrahedron = decodeBody(
  triangleBody({ name: "tetrahedron", restPositions: bytes(corners), triangles: bytes(faces) }),
);
const scaled = (by: number) => ({ positions: corners.map((value) => by * value), poses: new Float32Array() });
const at = (vertex: number) => ({ body: "tetrahedron", vertex });

function measuring(body = tetrahedron): Measurements {
  return new Measurements(
    () => [body],
    (ref) => ({ name: `corner ${ref.vertex}`, body: ref.body, vertices: undefined }),
  );
}

test("TwoPointsGiveADistanceThatFollowsTheMotion", () => {
  const measurements = measuring();
  measurements.pick(at(1));
  expect(measurements.picked.value).toEqual([]); // no tool is active
  measurements.use("distance");
  measurements.pick(at(1));
  expect([measurements.all.value.length, measurements.picked.value.length]).toEqual([0, 1]);
  measurements.pick(at(2));
  const [distance] = measurements.all.value;
  expect(distance.name).toBe("corner 1 – corner 2");
  for (const by of [1, 3]) {
    const [[what, value]] = measurements.values(distance, scaled(by));
    expect(what).toBe("distance");
    expect(value).toBeCloseTo(by * Math.SQRT2, 6);
  }
});

test("ThreePointsGiveTheAngleAtTheSecond", () => {
  const measurements = measuring();
  measurements.use("angle");
  for (const vertex of [1, 0, 2]) measurements.pick(at(vertex));
  expect(measurements.values(measurements.all.value[0], scaled(1))).toEqual([["angle", Math.PI / 2]]);
});

test("AClosedStructureHasAnAreaAndAVolumeAPartOnlyAnArea", () => {
  const measurements = measuring();
  measurements.use("surface");
  measurements.pick(at(3));
  const part = { name: "floor", body: "tetrahedron", vertices: [0, 1, 2] };
  measurements.measureSurface(part);
  const [whole, floor] = measurements.all.value.map((each) => new Map(measurements.values(each, scaled(2))));
  expect(whole.get("volume")).toBeCloseTo(8 / 6, 6);
  expect(whole.get("area")).toBeCloseTo(6 + 2 * Math.sqrt(3), 5);
  expect([...floor]).toEqual([["area", 2]]);
  expect(measurements.all.value.map(({ points }) => points[0].vertex)).toEqual([3, 0]);
});

test("ARigidMotionChangesNoMeasurement", () => {
  const measurements = measuring({ ...tetrahedron, placement: Placement.RIGID });
  const half = Math.SQRT1_2; // a quarter turn about x
  const moved = { positions: new Float32Array(), poses: Float32Array.of(half, 0, 0, half, 5, 6, 7) };
  measurements.use("distance");
  for (const vertex of [1, 3]) measurements.pick(at(vertex));
  measurements.measureSurface({ name: "all", body: "tetrahedron", vertices: undefined });
  const [distance, surface] = measurements.all.value;
  expect(measurements.values(distance, moved)[0][1]).toBeCloseTo(Math.SQRT2, 5);
  expect(measurements.values(surface, moved)[1][1]).toBeCloseTo(1 / 6, 6);
  expect(measurements.places([at(3)], moved)[0][1]).toBeCloseTo(5, 5);
});

test("ValuesOverTimeMakeAGraphForEachQuantity", () => {
  const measurements = measuring();
  measurements.use("distance");
  for (const vertex of [0, 1, 0, 2]) measurements.pick(at(vertex));
  measurements.measureSurface({ name: "all", body: "tetrahedron", vertices: undefined });
  for (const time of [1, 2, 3]) measurements.receive(time, scaled(time));
  expect(measurements.graphs.map(({ spec }) => [spec.id, spec.unit, spec.curves.length])).toEqual([
    ["measured-distance", "mm", 2],
    ["measured-area", "cm²", 1],
    ["measured-volume", "ml", 1],
  ]);
  const [{ spec, history }] = measurements.graphs;
  expect(history.series.get(spec.curves[1].key)).toEqual([1, 2, 3]);
  measurements.remove(measurements.all.value[2].id);
  expect(measurements.graphs.map(({ spec: { id } }) => id)).toEqual(["measured-distance"]);
});

test("EndingDropsPickedPointsAndClearingAll", () => {
  const measurements = measuring();
  measurements.use("distance");
  for (const vertex of [0, 1, 2]) measurements.pick(at(vertex));
  measurements.use(undefined);
  expect([measurements.picked.value.length, measurements.all.value.length]).toEqual([0, 1]);
  measurements.clear();
  expect([measurements.all.value.length, measurements.graphs.length]).toEqual([0, 0]);
});

test("TheOldestOfMoreThanTwelveIsDropped", () => {
  const measurements = measuring();
  for (let i = 0; i < 14; i++)
    measurements.measureSurface({ name: String(i), body: "tetrahedron", vertices: undefined });
  expect(measurements.all.value.map(({ name }) => name)).toEqual(Array.from({ length: 12 }, (_, i) => String(i + 2)));
});

test("ValuesAreFormattedInTheirUnits", () => {
  expect(quantityText("distance", 0.01234)).toBe("12.3 mm");
  expect(quantityText("angle", Math.PI / 4)).toBe("45.0°");
  expect(quantityText("angle", NaN)).toBe("undefined");
  expect(quantityText("area", 0.08124)).toBe("812.4 cm²");
  expect(quantityText("area", 0.0000503)).toBe("50.3 mm²");
  expect(quantityText("volume", 0.0012034)).toBe("1203 ml");
});

test("KeptMeasurementsAreFoundAgainByTheirPlacesAtRest", () => {
  const measurements = measuring();
  measurements.use("distance");
  for (const vertex of [1, 2]) measurements.pick(at(vertex));
  measurements.measureSurface({ name: "all", body: "tetrahedron", vertices: undefined });
  const kept = measurements.kept();
  expect(kept).toEqual([
    {
      tool: "distance",
      points: [
        { body: "tetrahedron", rest: [1, 0, 0] },
        { body: "tetrahedron", rest: [0, 1, 0] },
      ],
    },
    { tool: "body", points: [{ body: "tetrahedron", rest: [0, 0, 0] }] },
  ]);
  const other = measuring();
  other.replaceKept(kept);
  const values = (each: Measurements) => each.all.value.map((one) => each.values(one, scaled(2)));
  expect(values(other)).toEqual(values(measurements));
});

test("AStepsMeasurementsReplaceThoseOfTheStepBeforeAndNotTheUsers", () => {
  const measurements = measuring();
  measurements.measureSurface({ name: "own", body: "tetrahedron", vertices: undefined });
  measurements.replaceKept([{ tool: "surface", points: [{ body: "tetrahedron", rest: [0.9, 0.1, 0] }] }]);
  expect(measurements.all.value.map(({ name }) => name)).toEqual(["own", "corner 1"]);
  measurements.replaceKept([{ tool: "body", points: [{ body: "unknown", rest: [0, 0, 0] }] }]);
  expect(measurements.all.value.map(({ name }) => name)).toEqual(["own"]);
});

test("AStepWithTwelveMeasurementsLeavesTheUsers", () => {
  const kept = Array.from({ length: 12 }, () => ({
    tool: "body" as const,
    points: [{ body: "tetrahedron", rest: [0, 0, 0] as const }],
  }));
  const measurements = measuring();
  const own = (name: string) => measurements.measureSurface({ name, body: "tetrahedron", vertices: undefined });
  const names = () => measurements.all.value.map(({ name }) => name).filter((name) => name.startsWith("own"));
  own("own 0");
  measurements.replaceKept(kept);
  expect([measurements.all.value.length, names()]).toEqual([12, ["own 0"]]);
  for (let i = 1; i < 12; i++) own(`own ${i}`);
  expect([measurements.all.value.length, names().length]).toEqual([12, 12]);
  measurements.replaceKept(kept);
  expect(names().length).toBe(12);
});
