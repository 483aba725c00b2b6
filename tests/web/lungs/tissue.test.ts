import { create } from "@bufbuild/protobuf";
import { describe, expect, test } from "vitest";
import { GetTissueResponseSchema } from "../../../web/src/gen/phrenic/v1/tissue_pb";
import { Lattice } from "../../../web/src/lungs/lattice";
import { pointOf, TissuePoints } from "../../../web/src/lungs/tissue_points";
import { TissueQueries } from "../../../web/src/lungs/tissue_queries";
import { largestStrain, Places, type TissueKind, TissueState } from "../../../web/src/lungs/tissue_state";
import { bytesOf, FakeServer } from "../fakes/fake_server";

const edge = 0.014;
const cells = [3, 2, 2];
const nodesAlong = cells.map((each) => each + 1);

/** Nodes of the whole lattice, x fastest [m]; the last cell has no brick, but all of its corners but one are nodes. */
function nodes(): [number, number, number][] {
  const all: [number, number, number][] = [];
  for (let z = 0; z < nodesAlong[2]; z++)
    for (let y = 0; y < nodesAlong[1]; y++)
      for (let x = 0; x < nodesAlong[0]; x++) all.push([0.01 + x * edge, -0.02 + y * edge, 0.2 + z * edge]);
  return all.slice(0, -1);
}

/** A lung whose shapes are these motions of its points [1]. */
function lung(...motions: ((x: number, y: number, z: number) => [number, number, number])[]) {
  const bricks = new Uint8Array(12).fill(255);
  bricks[11] = 0;
  const shapes = motions.flatMap((motion) => nodes().flatMap((node) => motion(...node)));
  return create(GetTissueResponseSchema, {
    lungCount: 1,
    name: "lung-right",
    origin: { x: 0.01, y: -0.02, z: 0.2 },
    edge,
    cells,
    bricks,
    shapes: bytesOf(new Float32Array(shapes)),
    shapeCount: motions.length,
  });
}

/** An affine motion: u = G x + (0.001, 0, 0). */
const gradient = [0.1, 0.04, 0, 0, -0.02, 0, 0.06, 0, 0.05];
const affine = (x: number, y: number, z: number): [number, number, number] => [
  gradient[0] * x + gradient[1] * y + gradient[2] * z + 0.001,
  gradient[3] * x + gradient[4] * y + gradient[5] * z,
  gradient[6] * x + gradient[7] * y + gradient[8] * z,
];

describe("lung tissue", () => {
  test("IsExactForAnAffineMotion", () => {
    const state = new TissueState(new Lattice(lung(affine)), [1]);
    const at = [0.027, -0.003, 0.213] as const;
    const place = state.lattice.place(...at);
    affine(...at).forEach((u, k) => expect(state.displacementAt(place)[k]).toBeCloseTo(u, 7));
    const value = (kind: TissueKind) => new Places(state.lattice, at).values(state.nodal(kind))[0];
    expect(value("displacement")).toBeCloseTo(1000 * Math.hypot(...affine(...at)), 1);
    expect(value("ventilation")).toBeCloseTo(13, 3);
    expect(value("strain")).toBeCloseTo(100 * largestStrain(gradient), 3);
    const now = at.map((each, k) => each + affine(...at)[k]);
    expect(state.reader("ventilation")(now[0], now[1], now[2])).toBeCloseTo(13, 3);
  });

  test("IsASumOfItsShapes", () => {
    const lattice = new Lattice(lung(affine, () => [0, 0, 1]));
    const place = lattice.place(0.02, 0, 0.21);
    const [one, other] = [new TissueState(lattice, [1, 0]), new TissueState(lattice, [2, -0.01])];
    const [u, v] = [one, other].map((each) => each.displacementAt(place));
    expect(v[0]).toBeCloseTo(2 * u[0], 7);
    expect(v[2]).toBeCloseTo(2 * u[2] - 0.01, 7);
  });

  test("HasNoValuesWhereNothingMoves", () => {
    const lattice = new Lattice(lung(affine));
    const state = new TissueState(lattice, [0]);
    const places = new Places(lattice, [0.02, 0, 0.21, 0.03, -0.01, 0.22]);
    for (const kind of ["displacement", "ventilation", "strain"] as const)
      expect([...places.values(state.nodal(kind))].map(Math.abs)).toEqual([0, 0]);
  });

  test("IsFoundAtRestFromWhereItIsNow", () => {
    const state = new TissueState(new Lattice(lung(affine)), [0.5]);
    const rest = [0.025, -0.004, 0.212] as const;
    const now = rest.map((each, k) => each + 0.5 * affine(...rest)[k]);
    const found = state.placeOf(now[0], now[1], now[2]);
    const exact = state.lattice.place(...rest);
    expect(found.brick).toBe(exact.brick);
    found.local.forEach((each, k) => expect(edge * Math.abs(each - exact.local[k])).toBeLessThan(2e-4));
  });

  test("OutsideTheBricksIsThatOfTheNearestBrick", () => {
    const lattice = new Lattice(lung(affine));
    const { brick, local } = lattice.place(1, 1, 1);
    expect(brick).toBeLessThan(11);
    for (const each of local) expect(each).toBeLessThanOrEqual(1);
  });

  test("OfAWrongLengthIsRefused", () => {
    const message = lung(affine);
    expect(() => new Lattice({ ...message, shapeCount: 2 })).toThrow("lung-right.shapes");
    expect(() => new Lattice({ ...message, bricks: new Uint8Array(3) })).toThrow("lung-right.bricks");
    expect(() => new Lattice({ ...message, cells: [1] })).toThrow("lung-right.cells");
  });
});

test("TheLargestStrainIsAnEigenvalue", () => {
  expect(largestStrain([0, 0, 0, 0, 0, 0, 0, 0, 0])).toBe(0);
  expect(largestStrain([0.1, 0, 0, 0, -0.2, 0, 0, 0, 0.05])).toBeCloseTo(0.1, 12);
  expect(largestStrain([0, 0.2, 0, 0, 0, 0, 0, 0, 0])).toBeCloseTo(0.1, 12); // simple shear
  expect(largestStrain([0, 0.2, 0, -0.2, 0, 0, 0, 0, 0])).toBeCloseTo(0, 12); // a rotation
});

test("APointIsReadInMillimetres", () => {
  expect(pointOf("60, -20, 250")).toEqual([0.06, -0.02, 0.25]);
  expect(pointOf("60 20")).toBeUndefined();
  expect(pointOf("a, b, c")).toBeUndefined();
});

describe("queries", () => {
  function served() {
    const server = new FakeServer();
    server.tissue = { lungs: [lung(affine)], time: 1, amplitudes: [0.5], points: [] };
    return { server, queries: new TissueQueries(server.api, "thorax") };
  }

  test("LoadTheShapesOnceAndInterpolateInTime", async () => {
    const { server, queries } = served();
    await queries.query([], "1");
    server.tissue = { ...server.tissue!, time: 1.2, amplitudes: [0.7] };
    await queries.query([], "2");
    expect(server.tissueCalls).toEqual(["get", "read", "read"]);
    const place = queries.lungs.value[0].place(0.02, 0, 0.21);
    const whole = new TissueState(queries.lungs.value[0], [1]).displacementAt(place);
    const u = (time: number) => queries.at(time)[0].displacementAt(place)[2] / whole[2];
    expect(u(1)).toBeCloseTo(0.5, 5);
    expect(u(1.1)).toBeCloseTo(0.6, 5);
    expect(u(1.25)).toBeCloseTo(0.75, 5); // goes on
    expect(queries.at(3)).toEqual([]);
  });

  test("AskForOneStateOnce", async () => {
    const { server, queries } = served();
    await queries.query([], "1");
    await queries.query([], "1");
    expect(server.tissueCalls).toEqual(["get", "read"]);
  });

  test("SayWhyThereIsNoTissueAndDoNotAskAgain", async () => {
    const { server, queries } = served();
    server.tissue = undefined;
    await queries.query([], "1");
    expect(queries.message.value).toContain("the scene lacks lungs");
    await queries.query([], "2");
    expect(server.tissueCalls).toEqual(["get"]);
  });

  test("StartAgainAfterAReset", async () => {
    const { server, queries } = served();
    await queries.query([], "1");
    server.tissue = { ...server.tissue!, time: 0.1 };
    await queries.query([], "2");
    expect(queries.at(1)).toEqual([]);
    expect(queries.at(0.1).length).toBe(1);
  });
});

test("PointsAreFollowedAtMostSix", () => {
  const points = new TissuePoints();
  for (let i = 0; i < 7; i++) points.add([0.06, 0, 0.2 + 0.01 * i]);
  points.add([0.06, 0, 0.26]);
  expect(points.all.value.length).toBe(6);
  expect(points.all.value[0][2]).toBeCloseTo(0.21);
});
