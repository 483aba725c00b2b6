import { describe, expect, test } from "vitest";
import { Coloring } from "../../../web/src/appearance/coloring";
import { SurfaceFields } from "../../../web/src/appearance/fields";
import { decodeBody } from "../../../web/src/geometry/bodies";
import { areaChanges, displacements, speeds } from "../../../web/src/geometry/deformation";
import { ForceQueries } from "../../../web/src/session/force_queries";
import { FakeServer, triangleBody } from "../fakes/fake_server";

const body = decodeBody(triangleBody({}));
const { rest, triangles } = body;
const moved = (change: (x: number, y: number, z: number) => number[]) =>
  new Float32Array([0, 3, 6].flatMap((i) => change(rest[i], rest[i + 1], rest[i + 2])));
const close = (values: ArrayLike<number>, wanted: number) => {
  for (let i = 0; i < values.length; i++) expect(values[i]).toBeCloseTo(wanted, 3);
};

describe("the fields of a body", () => {
  test("RigidMotionHasDisplacementButNoStrain", () => {
    const shifted = moved((x, y, z) => [x + 0.003, y, z + 0.004]);
    close(displacements(rest, shifted), 5);
    close(speeds(rest, shifted, 0.5), 10);
    const turned = moved((x, y, z) => [-y, x, z]);
    close(areaChanges(rest, turned, triangles), 0);
  });

  test("AreaChangeOfAStretchedSheet", () => {
    close(
      areaChanges(
        rest,
        moved((x, y, z) => [1.1 * x, 1.1 * y, z]),
        triangles,
      ),
      21,
    );
    close(
      areaChanges(
        rest,
        moved((x, y, z) => [0.5 * x, y, z]),
        triangles,
      ),
      -50,
    );
  });

  test("SpeedNeedsTwoFrames", () => {
    const fields = new SurfaceFields();
    expect(fields.of("speed", body)).toBeUndefined();
    const poses = new Float32Array();
    fields.receive(1, { positions: rest, poses });
    close(fields.of("speed", body)!, 0);
    fields.receive(1.5, { positions: moved((x, y, z) => [x, y, z + 0.01]), poses });
    close(fields.of("speed", body)!, 20);
    // Time that goes back is a restart, not motion.
    fields.receive(0, { positions: rest, poses });
    close(fields.of("speed", body)!, 0);
  });
});

test("TheScaleIsConstantUntilItIsFittedOrSet", () => {
  const coloring = new Coloring(new ForceQueries(new FakeServer().api, "cube"));
  coloring.start([body]);
  const lift = (time: number, metres: number) =>
    coloring.receive(time, { positions: moved((x, y, z) => [x, y, z + metres]), poses: new Float32Array() });
  expect(coloring.colors().size).toBe(0);
  coloring.choose("displacement");
  expect(coloring.scale.value!.top).toBe(10);
  lift(1, 0.0305);
  expect(coloring.scale.value!.top).toBe(10);
  const beyond = coloring.colors().get("triangle");
  coloring.fit();
  expect(coloring.scale.value!.top).toBe(35);
  expect(coloring.colors().get("triangle")).not.toEqual(beyond);
  coloring.setTop(12);
  coloring.setTop(NaN);
  expect(coloring.scale.value!.top).toBe(12);
  coloring.choose("area");
  expect([coloring.scale.value!.low, coloring.scale.value!.unit]).toEqual([-5, "%"]);
  coloring.choose(undefined);
  expect(coloring.scale.value).toBeUndefined();
});
